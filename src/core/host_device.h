// Marks functions shared by CPU and CUDA code, in *_kernels.h and similar headers. On the CPU they
// are always inlined, because the same header is compiled with and without AVX2. Otherwise the
// linker could keep an out-of-line AVX2 copy and use it in the portable path.
#pragma once

#ifdef __CUDACC__
#define TESSERA_HD __host__ __device__ inline
#define TESSERA_HD_MEMBER __host__ __device__
#else
#define TESSERA_HD [[gnu::always_inline]] inline
#define TESSERA_HD_MEMBER [[gnu::always_inline]]
#endif
