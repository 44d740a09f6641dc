# Compiler settings shared by every target, as two interface targets:
#   eigengrain_flags     what every user of the headers needs too (exported)
#   eigengrain_warnings  what only our own code is held to (not exported)
#   eigengrain_own       both, and the rule of floating point: every target but the kernels (src/assembly)
add_library(eigengrain_flags INTERFACE)
target_compile_features(eigengrain_flags INTERFACE cxx_std_20)
if(EIGENGRAIN_ASSERTIONS)
  target_compile_definitions(eigengrain_flags INTERFACE EIGENGRAIN_ASSERTIONS)
endif()

add_library(eigengrain_warnings INTERFACE)
target_compile_options(eigengrain_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual
  -Wunused -Woverloaded-virtual -Wdouble-promotion -Wextra-semi
  -Wno-restrict)  # false alarms of GCC 12 in std::string (PR105651)
if(EIGENGRAIN_WERROR)
  target_compile_options(eigengrain_warnings INTERFACE -Werror)
endif()
if(EIGENGRAIN_ASSERTIONS)
  target_compile_definitions(eigengrain_warnings INTERFACE _GLIBCXX_ASSERTIONS)
else()
  # Without our assertions Eigen's are off too: they sit in the innermost loops.
  target_compile_definitions(eigengrain_warnings INTERFACE $<$<NOT:$<CONFIG:Debug>>:EIGEN_NO_DEBUG>)
endif()
add_library(eigengrain_own INTERFACE)
target_link_libraries(eigengrain_own INTERFACE eigengrain_warnings)
# No fused multiply-add that the source does not ask for, so that a result does not depend on how the compiler
# happened to vectorise a loop (docs/architecture.md).
target_compile_options(eigengrain_own INTERFACE -ffp-contract=off)
if(EIGENGRAIN_SANITIZE)
  # Without the checks of every single pointer: what they find in memory the address sanitizer finds too, and they take
  # half of the time of a build.
  target_compile_options(eigengrain_flags INTERFACE -fsanitize=${EIGENGRAIN_SANITIZE}
                         -fno-sanitize=null,alignment,object-size,vptr
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(eigengrain_flags INTERFACE -fsanitize=${EIGENGRAIN_SANITIZE})
endif()

# What nearly every file of a target reads, parsed once: a third of a build would go into Eigen alone. Off, it shows
# which file forgets to include what it uses.
#   eigengrain_precompile(<target> <headers...>)
function(eigengrain_precompile target)
  if(EIGENGRAIN_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <Eigen/Dense> <string> <vector> <span> <variant> ${ARGN})
  endif()
endfunction()
