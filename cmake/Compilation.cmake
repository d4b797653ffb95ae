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
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()
