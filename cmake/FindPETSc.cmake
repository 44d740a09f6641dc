# PETSc through its pkg-config file, as the imported target PETSc::PETSc.
# The file does not carry MPI's include paths, so MPI::MPI_CXX is linked beside it.
find_package(PkgConfig REQUIRED)
pkg_search_module(PETSC QUIET IMPORTED_TARGET GLOBAL PETSc petsc)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PETSc REQUIRED_VARS PETSC_LINK_LIBRARIES VERSION_VAR PETSC_VERSION)
if(PETSc_FOUND AND NOT TARGET PETSc::PETSc)
  add_library(PETSc::PETSc INTERFACE IMPORTED)
  target_link_libraries(PETSc::PETSc INTERFACE PkgConfig::PETSC MPI::MPI_CXX)
endif()
