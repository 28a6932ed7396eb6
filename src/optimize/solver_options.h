// Common Ceres options for sparse problems. Include only in sources that are built with Ceres.
#pragma once

#include <ceres/ceres.h>

namespace tessera {

// No logging, runs on the calling thread; deterministic.
inline ceres::Solver::Options SparseSolverOptions(int max_iterations) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // SuiteSparse would bring in a BLAS with threads that we do not control.
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE))
        options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.max_num_iterations = max_iterations;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    return options;
}

}  // namespace tessera
