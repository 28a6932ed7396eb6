// Residual of an edge, for plain numbers and automatic differentiation.
#pragma once

#include <Eigen/Geometry>

#include "optimize/pose_graph.h"

namespace tessera {

// In standard deviations: root_information times the error, which is the rotation (twice the vector
// part of the error quaternion), then the translation, of T_from_to^-1 T_world_from^-1 T_world_to.
struct EdgeResidual {
    PoseEdge edge;

    // Rotations are unit quaternions (Eigen's order: x, y, z, w), world from camera.
    template <class T>
    bool operator()(const T* rotation_from, const T* translation_from, const T* rotation_to,
                    const T* translation_to, T* residual) const {
        using Quaternion = Eigen::Quaternion<T>;
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Quaternion> q_from(rotation_from), q_to(rotation_to);
        const Eigen::Map<const Vector> t_from(translation_from), t_to(translation_to);
        const Eigen::Quaterniond q_edge(edge.T_from_to.linear());
        const Quaternion q_from_to = q_from.conjugate() * q_to;
        const Vector t_from_to = q_from.conjugate() * (t_to - t_from);
        const Quaternion edge_inverse = q_edge.conjugate().template cast<T>();
        Quaternion q_error = edge_inverse * q_from_to;
        if (q_error.w() < T(0)) q_error.coeffs() = -q_error.coeffs();
        const Vector t_error =
            edge_inverse * (t_from_to - edge.T_from_to.translation().template cast<T>());
        Eigen::Matrix<T, 6, 1> error;
        error.template head<3>() = q_error.vec() * T(2);
        error.template tail<3>() = t_error;
        Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
        r = edge.root_information.template cast<T>() * error;
        return true;
    }
};

}  // namespace tessera
