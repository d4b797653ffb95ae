# What keeps the compilation of the whole tree short; docs/performance.md, section Build, has the numbers.

# liebench_unity(TARGET BATCH): compiles the sources of TARGET in batches of BATCH as one. For sources whose headers cost
# more than they do themselves (JSON, command line, GoogleTest). Names in their unnamed namespaces share a scope then.
function(liebench_unity target batch)
  set_target_properties(
    ${target} PROPERTIES UNITY_BUILD ${LIEBENCH_UNITY} UNITY_BUILD_BATCH_SIZE ${batch})
endfunction()

# liebench_cold(TARGET): code that runs once a command, not once a step. In release what -O3 gains in its run it loses
# many times in its compilation.
function(liebench_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# liebench_precompile(TARGET HEADERS...): the headers that every source of TARGET reads anyhow, read once.
function(liebench_precompile target)
  if(NOT LIEBENCH_SYNTAX_ONLY)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Clang's front end, where its warnings come from, without its back end: what is called an object is Clang's file of
# diagnostics (a second command would do, too, but clang-tidy reads compile_commands.json); a library and a program are
# empty files.
if(LIEBENCH_SYNTAX_ONLY)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "LIEBENCH_SYNTAX_ONLY is for Clang, not for ${CMAKE_CXX_COMPILER_ID}")
  endif()
  set(CMAKE_CXX_COMPILE_OBJECT
      "<CMAKE_CXX_COMPILER> <DEFINES> <INCLUDES> <FLAGS> -fsyntax-only --serialize-diagnostics <OBJECT> -c <SOURCE>")
  set(CMAKE_CXX_CREATE_STATIC_LIBRARY "<CMAKE_COMMAND> -E touch <TARGET>")
  set(CMAKE_CXX_LINK_EXECUTABLE "<CMAKE_COMMAND> -E touch <TARGET>")
  set(CMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE PRE_TEST)
endif()
