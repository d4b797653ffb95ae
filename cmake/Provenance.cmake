# liebench_provenance(TARGET HEADER): compiles into TARGET what the records say of this build (commit, compiler, flags,
# library versions). The commit is read at every build; the file changes only when it does.
function(liebench_provenance target header)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}" flags)
  if(LIEBENCH_SANITIZE)
    string(APPEND flags " -fsanitize=address,undefined")
  endif()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/build_info.cpp")
  add_custom_target(
    ${target}_provenance
    COMMAND
      "${CMAKE_COMMAND}" "-DOUTPUT=${source}" "-DHEADER=${header}" "-DSOURCE_DIR=${PROJECT_SOURCE_DIR}"
      "-DVERSION=${PROJECT_VERSION}" "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
      "-DFLAGS=${flags} -ffp-contract=off -fno-math-errno" "-DQD=${QD_VERSION}" -P
      "${PROJECT_SOURCE_DIR}/cmake/write_build_info.cmake"
    BYPRODUCTS "${source}"
    VERBATIM)
  set_source_files_properties("${source}" PROPERTIES GENERATED TRUE SKIP_UNITY_BUILD_INCLUSION TRUE)
  target_sources(${target} PRIVATE "${source}")
  add_dependencies(${target} ${target}_provenance)
endfunction()
