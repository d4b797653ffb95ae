# The Debian packages of the two components of cmake/Install.cmake: `cpack --preset release` writes them to build/release/packages.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME liebench)
set(CPACK_PACKAGE_VENDOR "The liebench authors")
set(CPACK_PACKAGE_CONTACT "The liebench authors <maintainers@liebench.invalid>")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES TRUE)
set(CPACK_COMPONENTS_ALL program library)
set(CPACK_DEB_COMPONENT_INSTALL TRUE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME liebench)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS TRUE)
# Runs and tables need no gnuplot, pictures do.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
# The first line is the synopsis.
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "compares Lie group integrators of mechanical systems
What accuracy costs when a mechanical system with large rotations is
integrated in time by a Lie group method: runs become JSON records with
errors, exact cost counts and times, and records become convergence plots,
work-precision diagrams and tables.")

# The headers of groups, problems and integrators need Eigen, scenes and harness what they were built with.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libliebench-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS
    "libbenchmark-dev, libboost-dev, libceres-dev, libfmt-dev, libmuparser-dev, libqd-dev, libsuitesparse-dev, libxxhash-dev, nlohmann-json3-dev")
if(liebench_with_sundials)
  string(APPEND CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS ", libsundials-dev")
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "cmake, pkgconf")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
    "Lie group integrators of mechanical systems, for C++20
Headers with Lie groups, mechanical systems and integrators, which need
Eigen only, and static libraries with scenes, reference solutions and the
harness of liebench; CMake package and pkg-config files.")

include(CPack)
