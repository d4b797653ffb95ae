# Finds xxHash, the hash behind the keys of records and of cached references.
#
#   XxHash_FOUND, XxHash_VERSION
#   XxHash::XxHash      imported target: header <xxhash.h>, library xxhash
#   XxHash_INCLUDE_DIR, XxHash_LIBRARY      cache entries, to set where xxHash lives elsewhere

find_path(XxHash_INCLUDE_DIR NAMES xxhash.h)
find_library(XxHash_LIBRARY NAMES xxhash)
mark_as_advanced(XxHash_INCLUDE_DIR XxHash_LIBRARY)

unset(XxHash_VERSION)
if(XxHash_INCLUDE_DIR)
  set(_xxhash_numbers)
  foreach(_xxhash_part MAJOR MINOR RELEASE)
    file(STRINGS "${XxHash_INCLUDE_DIR}/xxhash.h" _xxhash_line LIMIT_COUNT 1
      REGEX "^#[ \t]*define[ \t]+XXH_VERSION_${_xxhash_part}[ \t]+[0-9]+")
    if(_xxhash_line MATCHES "[0-9]+[ \t]*$")
      string(STRIP "${CMAKE_MATCH_0}" _xxhash_line)
      list(APPEND _xxhash_numbers "${_xxhash_line}")
    endif()
  endforeach()
  list(JOIN _xxhash_numbers "." XxHash_VERSION)
  unset(_xxhash_numbers)
  unset(_xxhash_line)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(XxHash
  REQUIRED_VARS XxHash_LIBRARY XxHash_INCLUDE_DIR VERSION_VAR XxHash_VERSION)

if(XxHash_FOUND AND NOT TARGET XxHash::XxHash)
  add_library(XxHash::XxHash UNKNOWN IMPORTED)
  set_target_properties(XxHash::XxHash PROPERTIES
    IMPORTED_LOCATION "${XxHash_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${XxHash_INCLUDE_DIR}")
endif()
