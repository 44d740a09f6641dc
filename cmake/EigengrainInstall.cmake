# Installs the program, the static libraries, the public headers, and a package for find_package(Eigengrain)
# with the targets eigengrain::core, eigengrain::cycle and, where built, eigengrain::solvers.
include(CMakePackageConfigHelpers)
set(EIGENGRAIN_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Eigengrain)

set_target_properties(eigengrain_flags PROPERTIES EXPORT_NAME flags)
install(TARGETS eigengrain RUNTIME)
install(TARGETS eigengrain_flags eigengrain_core eigengrain_cycle EXPORT EigengrainTargets ARCHIVE)
install(EXPORT EigengrainTargets NAMESPACE eigengrain:: DESTINATION ${EIGENGRAIN_PACKAGE_DIR})

# Headers of folders that are not built do not install: nothing would be there to link with.
set(solver_headers PATTERN petsc EXCLUDE PATTERN timestep EXCLUDE PATTERN relaxation EXCLUDE PATTERN spectrum EXCLUDE)
set(finders cmake/FindHDF5MPI.cmake)
if(EIGENGRAIN_PETSC)
  # A file of its own, so that who asks for core or cycle only needs no PETSc.
  install(TARGETS eigengrain_solvers EXPORT EigengrainSolversTargets ARCHIVE)
  install(EXPORT EigengrainSolversTargets NAMESPACE eigengrain:: DESTINATION ${EIGENGRAIN_PACKAGE_DIR})
  set(solver_headers)
  list(APPEND finders cmake/FindPETSc.cmake cmake/FindSLEPc.cmake cmake/FindCHOLMOD.cmake cmake/FindSPQR.cmake)
endif()
install(DIRECTORY include/eigengrain DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" ${solver_headers})

configure_package_config_file(cmake/EigengrainConfig.cmake.in ${PROJECT_BINARY_DIR}/EigengrainConfig.cmake
                              INSTALL_DESTINATION ${EIGENGRAIN_PACKAGE_DIR})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/EigengrainConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/EigengrainConfig.cmake ${PROJECT_BINARY_DIR}/EigengrainConfigVersion.cmake
        ${finders} DESTINATION ${EIGENGRAIN_PACKAGE_DIR})
