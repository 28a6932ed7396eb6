// What two views of a still scene say about their camera: intensities of one that the other must
// show where its depths, the motion between them and the camera put them.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/se3.h"
#include "optimize/camera_view.h"

namespace tessera {

// The camera's unknowns, against the camera that was given.
struct CameraUnknowns {
    static constexpr int kCount = 4;

    double log_focal = 0;               // of the factor of fx and fy
    double centre_x = 0, centre_y = 0;  // shift of the principal point, in image widths
    // From the first row to the last: a rolling shutter; 0 for a global one.
    double readout_s = 0;

    PinholeCamera Applied(const PinholeCamera& given) const;
    void Add(const Eigen::Matrix<double, kCount, 1>& step);
};

struct CameraPair {
    int from = 0, to = 0;  // views
    Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
    // Intensity in `to` = (1 + gain) times that in `from`, + offset.
    double gain = 0, offset = 0;
    Vector6d velocity_from = Vector6d::Zero();  // twist a second in the camera's own frame
    Vector6d velocity_to = Vector6d::Zero();
    double scale = 0.05;  // of its residuals, [0, 1]
    bool usable = true;
};

// Normal equations. Unknowns: the motion (twist, from the left), gain, offset, then CameraUnknowns
// in their order.
struct CameraPairSums {
    static constexpr int kOwn = 8, kAll = kOwn + CameraUnknowns::kCount;
    using Vector = Eigen::Matrix<double, kAll, 1>;

    Eigen::Matrix<double, kAll, kAll> hessian = Eigen::Matrix<double, kAll, kAll>::Zero();
    std::array<Vector, CameraView::kRegions> gradient;  // by region
    int points = 0, used = 0;
    double error = 0;     // robust, in squared scales, summed
    double scale = 0.05;  // robust standard deviation of the residuals

    CameraPairSums() { gradient.fill(Vector::Zero()); }
};

// One point's residual in `to`, and its derivatives; false where it is not seen there.
struct CameraPairResidual {
    double value = 0;
    CameraPairSums::Vector jacobian = CameraPairSums::Vector::Zero();
};
bool EvaluatePoint(const CameraViewPoint& point, const CameraView::Level& to,
                   const PinholeCamera& camera, const CameraPair& pair, double readout_s,
                   CameraPairResidual& residual);

// `camera`: the one given, at full resolution.
CameraPairSums SumPair(const CameraView& from, const CameraView& to, int level,
                       const PinholeCamera& camera, const CameraUnknowns& unknowns,
                       const CameraPair& pair);

}  // namespace tessera
