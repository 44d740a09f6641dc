# The steps of the test install_consumer; its arguments are in CMakeLists.txt.
set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${WORK})

function(must_succeed)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

must_succeed(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} OUTPUT_QUIET)
# Only the prefix names Eigengrain, and the environment does not lead back to the build either.
must_succeed(${CMAKE_COMMAND} -E env --unset=CMAKE_PREFIX_PATH --unset=Eigengrain_DIR
  ${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON)
file(STRINGS ${WORK}/build/CMakeCache.txt found REGEX "^Eigengrain_DIR:")
string(FIND "${found}" "${prefix}/" at)
if(at EQUAL -1)
  message(FATAL_ERROR "another installation was found: ${found}")
endif()
must_succeed(${CMAKE_COMMAND} --build ${WORK}/build)

execute_process(COMMAND ${WORK}/build/consumer OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
message("${output}")
if(EXPECT_SOLVERS AND NOT output MATCHES "\ntrue ")
  message(FATAL_ERROR "the package was installed without its component solvers")
endif()

execute_process(COMMAND ${prefix}/bin/eigengrain --version OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "${VERSION}")
  message(FATAL_ERROR "the installed program says version ${output}, not ${VERSION}")
endif()

if(PYTHON)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/${PACKAGE_DIR} PYTHONDONTWRITEBYTECODE=1
      ${PYTHON} -c "import eigengrain, eigengrain.plot; print(eigengrain.__version__, eigengrain.__file__)"
    WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "^${VERSION} ${prefix}/")
    message(FATAL_ERROR "the installed Python package is another one: ${output}")
  endif()
endif()

# Nothing installed may point back to the source or the build.
get_filename_component(source ${CONSUMER}/../../.. ABSOLUTE)
file(GLOB_RECURSE installed ${prefix}/*.cmake)
foreach(file IN LISTS installed)
  file(READ ${file} text)
  foreach(folder ${source} ${BUILD})
    string(FIND "${text}" "${folder}/" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()
