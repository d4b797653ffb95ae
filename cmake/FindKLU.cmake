# Finds KLU, the sparse LU factorization of SuiteSparse (Davis & Palamadai Natarajan 2010).
#
#   KLU_FOUND
#   KLU::KLU        imported target: header <klu.h>, library klu
#   KLU_INCLUDE_DIR, KLU_LIBRARY      cache entries, to set where KLU lives elsewhere

find_path(KLU_INCLUDE_DIR NAMES klu.h PATH_SUFFIXES suitesparse)
find_library(KLU_LIBRARY NAMES klu)
mark_as_advanced(KLU_INCLUDE_DIR KLU_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(KLU REQUIRED_VARS KLU_LIBRARY KLU_INCLUDE_DIR)

if(KLU_FOUND AND NOT TARGET KLU::KLU)
  add_library(KLU::KLU UNKNOWN IMPORTED)
  set_target_properties(KLU::KLU PROPERTIES
    IMPORTED_LOCATION "${KLU_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${KLU_INCLUDE_DIR}")
endif()
