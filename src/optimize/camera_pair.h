// Photometric constraint of two views of a static scene on their camera. A pixel of one view is
// projected into the other with its depth, the relative motion and the camera, and the intensities
// are compared.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/se3.h"
#include "optimize/camera_view.h"

namespace tessera {

// Unknowns of the camera, relative to the given camera.
struct CameraUnknowns {
    static constexpr int kCount = 5;

    double log_focal = 0;               // common factor of fx and fy
    double centre_x = 0, centre_y = 0;  // shift of the principal point, in image widths
    // Time between the first and the last row of a rolling shutter; 0 for a global shutter.
    double readout_s = 0;
    // Share of the brightness that is lost in the image's corners; it grows with the square of the
    // distance from the image's centre.
    double vignetting = 0;

    PinholeCamera Applied(const PinholeCamera& given) const;
    void Add(const Eigen::Matrix<double, kCount, 1>& step);
};

struct CameraPair {
    int from = 0, to = 0;  // indices of the views
    Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
    // Intensity in `to` = (1 + gain) times that in `from`, + offset.
    double gain = 0, offset = 0;
    Vector6d velocity_from = Vector6d::Zero();  // twist per second in the camera frame
    Vector6d velocity_to = Vector6d::Zero();
    double scale = 0.05;  // of the residuals, which are intensities in [0, 1]
    bool usable = true;
};

// Normal equations. Unknowns: the motion (left-multiplied twist), gain, offset, then CameraUnknowns
// in order.
struct CameraPairSums {
    static constexpr int kOwn = 8, kAll = kOwn + CameraUnknowns::kCount;
    using Vector = Eigen::Matrix<double, kAll, 1>;

    Eigen::Matrix<double, kAll, kAll> hessian = Eigen::Matrix<double, kAll, kAll>::Zero();
    std::array<Vector, CameraView::kRegions> gradient;  // by region
    int points = 0, used = 0;
    double error = 0;     // robust, in units of scale squared, summed
    double scale = 0.05;  // robust standard deviation of the residuals

    CameraPairSums() { gradient.fill(Vector::Zero()); }
};

// Residual of one point in `to` and its derivatives. EvaluatePoint returns false if `to` does not
// see the point.
struct CameraPairResidual {
    double value = 0;
    CameraPairSums::Vector jacobian = CameraPairSums::Vector::Zero();
};
// `camera`: with the unknowns applied, at the level's resolution.
bool EvaluatePoint(const CameraViewPoint& point, const CameraView::Level& to,
                   const PinholeCamera& camera, const CameraPair& pair,
                   const CameraUnknowns& unknowns, CameraPairResidual& residual);

// `camera`: the given one, at full resolution.
CameraPairSums SumPair(const CameraView& from, const CameraView& to, int level,
                       const PinholeCamera& camera, const CameraUnknowns& unknowns,
                       const CameraPair& pair);

}  // namespace tessera
