# liebench_embed(TARGET FUNCTION HEADER FILES...): compiles text files into TARGET, so that the program finds them
# wherever it is installed. FUNCTION(name), declared in HEADER, returns the text of a file by its name, FUNCTION_names() all names.
function(liebench_embed target function header)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
  add_custom_command(
    OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${source}" "-DFUNCTION=${function}" "-DHEADER=${header}" "-DFILES=${ARGN}"
            "-DBASE=${CMAKE_CURRENT_SOURCE_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    DEPENDS ${ARGN} "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    VERBATIM)
  target_sources(${target} PRIVATE "${source}")
endfunction()
