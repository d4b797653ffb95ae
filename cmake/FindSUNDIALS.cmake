# Finds the solvers CVODE, ARKODE and IDA of SUNDIALS with their serial vectors [Hindmarsh et al. 2005].
#
#   SUNDIALS_FOUND, SUNDIALS_VERSION
#   SUNDIALS::SUNDIALS      imported target: headers <cvode/cvode.h>, <arkode/arkode_erkstep.h>, <ida/ida.h>, ...
#   SUNDIALS_INCLUDE_DIR, SUNDIALS_<LIBRARY>_LIBRARY      cache entries, to set where SUNDIALS lives elsewhere
#
# Its own configuration file, as Debian has it, asks for MPI, of which nothing here has use.

find_path(SUNDIALS_INCLUDE_DIR NAMES sundials/sundials_config.h)
set(_sundials_libraries)
foreach(_sundials_part cvode arkode ida nvecserial)
  string(TOUPPER "SUNDIALS_${_sundials_part}_LIBRARY" _sundials_entry)
  find_library(${_sundials_entry} NAMES sundials_${_sundials_part})
  list(APPEND _sundials_libraries ${_sundials_entry})
endforeach()
mark_as_advanced(SUNDIALS_INCLUDE_DIR ${_sundials_libraries})

unset(SUNDIALS_VERSION)
if(SUNDIALS_INCLUDE_DIR)
  file(STRINGS "${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h" _sundials_line LIMIT_COUNT 1
    REGEX "^#[ \t]*define[ \t]+SUNDIALS_VERSION[ \t]+\"[0-9.]+")
  if(_sundials_line MATCHES "\"([0-9.]+)")
    set(SUNDIALS_VERSION "${CMAKE_MATCH_1}")
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SUNDIALS
  REQUIRED_VARS ${_sundials_libraries} SUNDIALS_INCLUDE_DIR VERSION_VAR SUNDIALS_VERSION HANDLE_VERSION_RANGE)

if(SUNDIALS_FOUND AND NOT TARGET SUNDIALS::SUNDIALS)
  add_library(SUNDIALS::SUNDIALS INTERFACE IMPORTED)
  target_include_directories(SUNDIALS::SUNDIALS SYSTEM INTERFACE "${SUNDIALS_INCLUDE_DIR}")
  foreach(_sundials_entry IN LISTS _sundials_libraries)
    target_link_libraries(SUNDIALS::SUNDIALS INTERFACE "${${_sundials_entry}}")
  endforeach()
endif()
unset(_sundials_libraries)
unset(_sundials_part)
unset(_sundials_entry)
unset(_sundials_line)
