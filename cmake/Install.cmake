# What `cmake --install` puts where: the program with its schemas, studies and scenes (component program), and headers, libraries,
# CMake package and pkg-config files (component library). docs/library.md is their manual. Nothing of a build tree gets into the
# latter: what only our own sources are compiled with is linked as $<BUILD_INTERFACE:...>.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME library)
set(liebench_headers "${CMAKE_INSTALL_INCLUDEDIR}/liebench")
set(liebench_package "${CMAKE_INSTALL_LIBDIR}/cmake/liebench")
set(liebench_data "${CMAKE_INSTALL_DATADIR}/liebench")

install(TARGETS liebench COMPONENT program)
foreach(schema record study scene stability)
  install(FILES "harness/${schema}.schema.json" DESTINATION "${liebench_data}" COMPONENT program)
endforeach()
install(DIRECTORY harness/studies problems/scenes DESTINATION "${liebench_data}" COMPONENT program)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright COMPONENT program)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/libliebench-dev" RENAME copyright)

# Without the command line, and without what knows SUNDIALS's headers.
install(
  DIRECTORY groups problems integrators plots harness
  DESTINATION "${liebench_headers}"
  FILES_MATCHING PATTERN "*.h"
  PATTERN problems/scenes EXCLUDE
  PATTERN harness/studies EXCLUDE
  PATTERN integrators/sheets EXCLUDE
  PATTERN harness/cli EXCLUDE
  PATTERN harness/outside EXCLUDE)

# Two sets: targets of headers, and those for which a consumer needs other libraries, too.
set(liebench_header_targets arithmetic groups extended problems integrators)
set(liebench_compiled_targets scenes references runs outside plots harness)
foreach(set header compiled)
  foreach(target IN LISTS liebench_${set}_targets)
    set_target_properties(liebench_${target} PROPERTIES EXPORT_NAME ${target})
    install(TARGETS liebench_${target} EXPORT liebench-${set} INCLUDES DESTINATION "${liebench_headers}")
  endforeach()
  install(
    EXPORT liebench-${set}
    NAMESPACE liebench::
    FILE liebench-${set}-targets.cmake
    DESTINATION "${liebench_package}")
endforeach()

set(liebench_find_modules KLU QD XxHash)
set(liebench_with_sundials FALSE)
if(TARGET SUNDIALS::SUNDIALS)
  set(liebench_with_sundials TRUE)
  list(APPEND liebench_find_modules SUNDIALS)
endif()
list(TRANSFORM liebench_find_modules REPLACE "(.+)" "cmake/Find\\1.cmake" OUTPUT_VARIABLE liebench_find_files)
install(FILES ${liebench_find_files} DESTINATION "${liebench_package}/modules")
configure_package_config_file(
  cmake/liebenchConfig.cmake.in "${PROJECT_BINARY_DIR}/liebenchConfig.cmake"
  INSTALL_DESTINATION "${liebench_package}"
  NO_SET_AND_CHECK_MACRO)
# 0.x: what is in a header may change with the minor version.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/liebenchConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(
  FILES "${PROJECT_BINARY_DIR}/liebenchConfig.cmake" "${PROJECT_BINARY_DIR}/liebenchConfigVersion.cmake"
  DESTINATION "${liebench_package}")

# Relative to where they are, as the CMake package is: the tree may be moved.
file(RELATIVE_PATH liebench_pc_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" liebench_pc_prefix "${liebench_pc_prefix}")
list(TRANSFORM liebench_compiled_targets PREPEND "-lliebench_" OUTPUT_VARIABLE liebench_pc_libraries)
list(REVERSE liebench_pc_libraries)
list(JOIN liebench_pc_libraries " " liebench_pc_libraries)
set(liebench_pc_sundials "")
if(liebench_with_sundials)
  set(liebench_pc_sundials " -lsundials_cvode -lsundials_arkode -lsundials_ida -lsundials_nvecserial")
endif()
foreach(part groups problems integrators harness)
  configure_file(cmake/liebench-${part}.pc.in "${PROJECT_BINARY_DIR}/liebench-${part}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/liebench-${part}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endforeach()
