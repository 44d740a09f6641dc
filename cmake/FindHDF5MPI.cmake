# HDF5 as built with MPI, through its pkg-config file (which carries MPI's include paths), as the imported target
# HDF5MPI::HDF5MPI. The variant with MPI because PETSc brings it along: two HDF5 in one process would clash.
find_package(PkgConfig REQUIRED)
pkg_search_module(HDF5MPI QUIET IMPORTED_TARGET GLOBAL hdf5-openmpi)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HDF5MPI REQUIRED_VARS HDF5MPI_LINK_LIBRARIES VERSION_VAR HDF5MPI_VERSION)
if(HDF5MPI_FOUND AND NOT TARGET HDF5MPI::HDF5MPI)
  add_library(HDF5MPI::HDF5MPI INTERFACE IMPORTED)
  target_link_libraries(HDF5MPI::HDF5MPI INTERFACE PkgConfig::HDF5MPI)
  target_compile_definitions(HDF5MPI::HDF5MPI INTERFACE OMPI_SKIP_MPICXX)  # MPI's C++ bindings, which nobody uses
endif()
