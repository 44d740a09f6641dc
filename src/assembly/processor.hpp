#pragma once

/// What the processor at hand has, asked when a kernel is picked.
namespace eigengrain::assembly {

/// AVX2 and fused multiply-add: what files compiled for EIGENGRAIN_KERNEL_AVX2 use.
inline bool runs_avx2_kernels() {
#ifdef EIGENGRAIN_KERNEL_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace eigengrain::assembly
