# SLEPc through its pkg-config file, as the imported target SLEPc::SLEPc.
find_package(PkgConfig REQUIRED)
pkg_search_module(SLEPC QUIET IMPORTED_TARGET GLOBAL SLEPc slepc)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SLEPc REQUIRED_VARS SLEPC_LINK_LIBRARIES VERSION_VAR SLEPC_VERSION)
if(SLEPc_FOUND AND NOT TARGET SLEPc::SLEPc)
  add_library(SLEPc::SLEPc INTERFACE IMPORTED)
  target_link_libraries(SLEPc::SLEPc INTERFACE PkgConfig::SLEPC PETSc::PETSc)
endif()
