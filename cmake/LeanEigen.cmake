# Every expression is a type of its own, for which the compiler declares all members of Eigen's DenseBase again: in tests
# two thirds of the front end's time (docs/performance.md, section Build). Nothing here takes views by lists of indices
# or reshaped ones, a third of that: the build reads a copy of Eigen's headers in which those two files are empty. Other
# code that was compiled with the whole ones links with it, for no function and no layout changes.
function(liebench_lean_eigen)
  set(lean "${PROJECT_BINARY_DIR}/eigen-${Eigen3_VERSION}")
  get_target_property(whole Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  if(NOT EXISTS "${lean}/Eigen/src/plugins/ReshapedMethods.h")
    file(COPY "${whole}/Eigen" DESTINATION "${lean}")
    foreach(methods IndexedViewMethods ReshapedMethods)
      file(WRITE "${lean}/Eigen/src/plugins/${methods}.h" "")
    endforeach()
  endif()
  set_target_properties(Eigen3::Eigen PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${lean}")
endfunction()
