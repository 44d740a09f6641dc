# SLEPc through its pkg-config file, as the imported target SLEPc::SLEPc; with LAPACK, which its headers declare and its
# own libraries link with.
find_package(PkgConfig REQUIRED)
pkg_search_module(SLEPC QUIET IMPORTED_TARGET GLOBAL SLEPc slepc)
find_library(SLEPC_LAPACK lapack)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SLEPc REQUIRED_VARS SLEPC_LINK_LIBRARIES SLEPC_LAPACK VERSION_VAR SLEPC_VERSION)
mark_as_advanced(SLEPC_LAPACK)
if(SLEPc_FOUND AND NOT TARGET SLEPc::SLEPc)
  add_library(SLEPc::SLEPc INTERFACE IMPORTED)
  target_link_libraries(SLEPc::SLEPc INTERFACE PkgConfig::SLEPC PETSc::PETSc ${SLEPC_LAPACK})
endif()
