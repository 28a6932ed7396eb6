// Model of a depth measurement under an unknown calibration, and the residual between two views.
// Templates, for plain numbers and for automatic differentiation.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace tessera {

// Unknowns of the calibration.
struct CalibrationUnknowns {
    enum Index { kLogFocal, kOffset, kCount };

    // kLogFocal: logarithm of true over given focal length. kOffset: disparity offset, 1/m, as in
    // Calibration::disparity_offset_per_m.
    std::array<double, kCount> values{};
    // Standard deviations of the prior, from experience with depth cameras.
    static constexpr std::array<double, kCount> kPrior{0.03, 0.01};
};

// Point of a measured depth along `direction`, a ray of the given camera with z = 1.
template <class T>
Eigen::Matrix<T, 3, 1> CalibratedPoint(const Eigen::Vector2d& direction, double depth_m,
                                       const T* unknowns) {
    using U = CalibrationUnknowns;
    using std::exp;
    const T z = T(depth_m) / (T(1) + unknowns[U::kOffset] * depth_m);
    const T scale = z * exp(-unknowns[U::kLogFocal]);
    return {scale * direction.x(), scale * direction.y(), z};
}

// A point of one view and the plane of another view in which it should lie.
struct PlanePair {
    int from = 0, to = 0;
    Eigen::Vector2d direction_from, direction_to;
    double depth_from_m = 0, depth_to_m = 0, sigma_m = 0;
    Eigen::Vector3d normal;  // in the frame of camera `to`; held fixed while solving

    // Point-to-plane distance in standard deviations. Rotations are unit quaternions (x, y, z, w),
    // world from camera.
    template <class T>
    bool operator()(const T* unknowns, const T* q_from, const T* t_from, const T* q_to,
                    const T* t_to, T* residual) const {
        using Quaternion = Eigen::Quaternion<T>;
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Quaternion> a(q_from), b(q_to);
        const Eigen::Map<const Vector> ta(t_from), tb(t_to);
        const Vector world = a * CalibratedPoint(direction_from, depth_from_m, unknowns) + ta;
        const Vector plane = CalibratedPoint(direction_to, depth_to_m, unknowns);
        const Vector off = b.conjugate() * (world - tb) - plane;
        // Expressed as an error of measured depth. A distance in the world would vanish if the
        // whole world shrank.
        const T stretch = T(1) + unknowns[CalibrationUnknowns::kOffset] * depth_to_m;
        residual[0] = normal.cast<T>().dot(off) * depth_to_m * stretch /
                      (normal.cast<T>().dot(plane) * sigma_m);
        return true;
    }
};

}  // namespace tessera
