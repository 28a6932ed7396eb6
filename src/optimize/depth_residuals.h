// Distances between the surfaces of two views, and how they depend on a depth distortion and on the
// motion between the views.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/depth_distortion.h"
#include "core/se3.h"
#include "optimize/depth_view.h"

namespace tessera {

// The nodes of the estimated distortion, in the order of DepthDistortion::per_m.
struct DistortionNodes {
    static constexpr int kColumns = 20, kRows = 15, kCount = kColumns * kRows;

    // Where a pixel of a view lies: its four nodes, their shares, and the error there.
    struct Place {
        int nodes[4];
        double share[4];
        double error_per_m = 0;
    };
    Place At(int x, int y, const PinholeCamera& view_camera) const;

    Eigen::VectorXd per_m = Eigen::VectorXd::Zero(kCount);
};

// A point of one view against the plane at its pixel in the other: their distance, divided by its
// standard deviation if each inverse depth has one of kDepthNoise_per_m (Sampson's distance).
struct DepthResidual {
    double value = 0;
    double z_m = 0;
    int nodes[8];
    double to_nodes[8];  // derivatives of `value`, m
    // By a twist from the left of T_to_from. The deviation is taken as constant here: its change
    // with the rotation made no difference to what is found.
    Vector6d to_motion;
};
inline constexpr double kDepthNoise_per_m = 0.001;

// `camera`: that of the views. Leaves out values beyond `gate`, and what is hidden or seen at a
// slant. Reuses the storage of `residuals`.
void FindDepthResiduals(const DepthView& from, const DepthView& to, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_to_from, const DistortionNodes& nodes,
                        double gate, std::vector<DepthResidual>& residuals);

}  // namespace tessera
