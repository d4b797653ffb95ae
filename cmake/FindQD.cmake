# Finds QD, the double-double and quad-double arithmetic of Hida, Li & Bailey.
#
#   QD_FOUND, QD_VERSION (empty where no qd.pc lies beside the library)
#   QD::QD       imported target: header <qd/dd_real.h>, library qd
#   QD_INCLUDE_DIR, QD_LIBRARY      cache entries, to set where QD lives elsewhere
#
# The headers carry no version, so it is read from qd.pc; pkg-config itself is not needed.

find_path(QD_INCLUDE_DIR NAMES qd/dd_real.h)
find_library(QD_LIBRARY NAMES qd)
mark_as_advanced(QD_INCLUDE_DIR QD_LIBRARY)

unset(QD_VERSION)
if(QD_LIBRARY)
  get_filename_component(_qd_dir "${QD_LIBRARY}" DIRECTORY)
  if(EXISTS "${_qd_dir}/pkgconfig/qd.pc")
    file(STRINGS "${_qd_dir}/pkgconfig/qd.pc" _qd_line REGEX "^Version:")
    string(REGEX REPLACE "^Version:[ \t]*" "" QD_VERSION "${_qd_line}")
  endif()
  unset(_qd_dir)
  unset(_qd_line)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(QD REQUIRED_VARS QD_LIBRARY QD_INCLUDE_DIR VERSION_VAR QD_VERSION)

if(QD_FOUND AND NOT TARGET QD::QD)
  add_library(QD::QD UNKNOWN IMPORTED)
  # Error-free transformations are inline in the headers and right only as written: no fused a * b + c.
  set_target_properties(QD::QD PROPERTIES
    IMPORTED_LOCATION "${QD_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${QD_INCLUDE_DIR}"
    INTERFACE_COMPILE_OPTIONS "$<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>")
endif()
