execute_process(
  COMMAND git -C "${SOURCE_DIR}" rev-parse HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
set(dirty false)
if(failed)
  set(commit "unknown")
else()
  execute_process(
    COMMAND git -C "${SOURCE_DIR}" status --porcelain --untracked-files=no -- . ":!results" ":!docs" ":!README.md"
    OUTPUT_VARIABLE changes ERROR_QUIET)
  if(NOT changes STREQUAL "")
    set(dirty true)
  endif()
endif()
set(text "#include \"${HEADER}\"

namespace liebench {

BuildInfo build_info() {
  return {.version = \"${VERSION}\",
          .commit = \"${commit}\",
          .dirty = ${dirty},
          .compiler = \"${COMPILER}\",
          .flags = \"${FLAGS}\",
          .qd = \"${QD}\"};
}

}  // namespace liebench
")
set(old "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" old)
endif()
if(NOT text STREQUAL old)
  file(WRITE "${OUTPUT}" "${text}")
endif()
