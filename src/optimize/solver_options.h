// How this library has Ceres solve sparse problems. Only for sources that Ceres is there for.
#pragma once

#include <ceres/ceres.h>

namespace tessera {

// Silent, on the calling thread: the same result on every run.
inline ceres::Solver::Options SparseSolverOptions(int max_iterations) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // SuiteSparse would bring a BLAS whose threads are not ours to count.
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE))
        options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.max_num_iterations = max_iterations;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    return options;
}

}  // namespace tessera
