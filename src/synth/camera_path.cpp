#include "synth/camera_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "io/trajectory.h"

namespace tessera {

Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up) {
    const Eigen::Vector3d z = (target - eye).normalized();
    const Eigen::Vector3d x = z.cross(up).normalized();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << x, z.cross(x), z;
    T.translation() = eye;
    return T;
}

Eigen::Isometry3d Tremor(double time_s) {
    // Hz; chosen so that their common period is long.
    constexpr double kFrequencies[3] = {0.83, 1.71, 3.37};
    constexpr double kWeights[3] = {1.0, 0.5, 0.2};
    Vector6d twist;
    for (int i = 0; i < 6; ++i) {
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            sum += kWeights[k] *
                   std::sin(2 * std::numbers::pi * kFrequencies[k] * (1 + 0.07 * i) * time_s +
                            1.3 * i + 2.1 * k);
        twist[i] = sum * (i < 3 ? 0.0042 : 0.0017);  // radians, metres
    }
    return Se3Exp(twist);
}

CameraPath SpedUp(CameraPath path, double speed) {
    return {
        [at = std::move(path.T_world_camera), speed](double time_s) { return at(speed * time_s); },
        path.duration_s / speed};
}

Result<CameraPath> ReadCameraPath(const std::string& file, const Eigen::Isometry3d* T_world_start) {
    Result<Trajectory> trajectory = ReadTrajectory(file);
    if (!trajectory.ok()) return trajectory.status();
    auto poses = std::make_shared<std::vector<StampedPose>>(std::move(trajectory.value().poses));
    if (poses->size() < 2) return Status::Error(file + ": needs at least two poses to move along");
    Eigen::Isometry3d T_world_recorded = Eigen::Isometry3d::Identity();
    if (T_world_start) T_world_recorded = *T_world_start * poses->front().T_world_camera.inverse();
    const double start_s = poses->front().stamp_s, end_s = poses->back().stamp_s;
    CameraPath path;
    path.duration_s = end_s - start_s;
    path.T_world_camera = [=](double time_s) {
        const auto T = InterpolatePose(*poses, std::clamp(start_s + time_s, start_s, end_s),
                                       std::numeric_limits<double>::infinity());
        return T_world_recorded * T.value_or(poses->front().T_world_camera);
    };
    return path;
}

}  // namespace tessera
