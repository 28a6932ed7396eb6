#include "optimize/pose_graph_residual.h"

namespace tessera {

Matrix6d RootInformation(double sigma_rad, double sigma_m) {
    Vector6d inverse;
    inverse << Eigen::Vector3d::Constant(1 / sigma_rad), Eigen::Vector3d::Constant(1 / sigma_m);
    return inverse.asDiagonal();
}

Vector6d EdgeResidual(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                      const Eigen::Isometry3d& T_world_to) {
    const Eigen::Quaterniond q_from(T_world_from.linear()), q_to(T_world_to.linear());
    const Eigen::Vector3d t_from = T_world_from.translation(), t_to = T_world_to.translation();
    Vector6d residual;
    EdgeResidualOf(edge, q_from.coeffs().data(), t_from.data(), q_to.coeffs().data(), t_to.data(),
                   residual.data());
    return residual;
}

}  // namespace tessera
