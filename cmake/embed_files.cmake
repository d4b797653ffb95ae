# Writes OUTPUT: a function that returns the text of one of FILES (relative to BASE) by its file name.
set(text "#include \"${HEADER}\"\n\nnamespace liebench {\n\nstd::string_view ${FUNCTION}(std::string_view name) {\n")
foreach(file IN LISTS FILES)
  file(READ "${BASE}/${file}" content)
  get_filename_component(name "${file}" NAME)
  string(APPEND text "  if (name == \"${name}\") return R\"~~~~(${content})~~~~\";\n")
endforeach()
string(APPEND text "  return {};\n}\n\n}  // namespace liebench\n")
file(WRITE "${OUTPUT}" "${text}")
