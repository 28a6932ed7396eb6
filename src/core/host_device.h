// Marks the functions of *_kernels.h and their like, which CPU code and CUDA share. On the CPU they
// are always inlined, because the same header is compiled with and without AVX2: an out-of-line
// copy compiled for AVX2 could otherwise be the one that the linker keeps for the portable path.
#pragma once

#ifdef __CUDACC__
#define TESSERA_HD __host__ __device__ inline
#define TESSERA_HD_MEMBER __host__ __device__
#else
#define TESSERA_HD [[gnu::always_inline]] inline
#define TESSERA_HD_MEMBER [[gnu::always_inline]]
#endif
