#include "viz/view_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera {
namespace {

constexpr double kHeightRad = 50 * std::numbers::pi / 180;
constexpr double kSteepestRad = 89 * std::numbers::pi / 180;

}  // namespace

void ViewCamera::SetUp(const Eigen::Vector3d& up) {
    const Eigen::Vector3d eye_before = up_.isZero() ? Eigen::Vector3d::Zero() : eye();
    const bool placed = !up_.isZero();
    up_ = up.normalized();
    const Eigen::Vector3d any =
        std::abs(up_.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    east_ = any.cross(up_).normalized();
    north_ = up_.cross(east_);
    if (placed) Place(eye_before, target_);
}

void ViewCamera::Place(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
    const Eigen::Vector3d offset = eye - target;
    target_ = target;
    distance_m_ = std::max(offset.norm(), 1e-3);
    elevation_rad_ = std::clamp(std::asin(std::clamp(offset.dot(up_) / distance_m_, -1.0, 1.0)),
                                -kSteepestRad, kSteepestRad);
    azimuth_rad_ = std::atan2(offset.dot(north_), offset.dot(east_));
}

void ViewCamera::Rotate(double right_rad, double down_rad) {
    azimuth_rad_ -= right_rad;
    elevation_rad_ = std::clamp(elevation_rad_ + down_rad, -kSteepestRad, kSteepestRad);
}

void ViewCamera::Turn(double right_rad, double down_rad) {
    const Eigen::Vector3d from = eye();
    azimuth_rad_ -= right_rad;
    elevation_rad_ = std::clamp(elevation_rad_ + down_rad, -kSteepestRad, kSteepestRad);
    target_ += from - eye();
}

void ViewCamera::Walk(double forward_m) { target_ += forward_m * (target_ - eye()).normalized(); }

double ViewCamera::PixelSize_m(double height_px) const {
    return 2 * distance_m_ * std::tan(kHeightRad / 2) / height_px;
}

void ViewCamera::Pan(double right_px, double down_px, double height_px) {
    const double metres_per_px = PixelSize_m(height_px);
    const Eigen::Matrix3d axes = T_world_camera().linear();
    target_ -= metres_per_px * (right_px * axes.col(0) + down_px * axes.col(1));
}

void ViewCamera::Zoom(double factor) {
    distance_m_ = std::clamp(distance_m_ * factor, 0.05, 500.0);
    follow_scale_ = std::clamp(follow_scale_ * factor, 0.1, 20.0);
}

void ViewCamera::ShowAll(const Eigen::AlignedBox3d& box) {
    if (box.isEmpty()) return;
    const double wanted_m = 0.76 * box.diagonal().norm();
    if ((target_ - box.center()).norm() < 0.03 * wanted_m &&
        std::abs(distance_m_ - wanted_m) < 0.03 * wanted_m)
        return;
    Place(box.center() - wanted_m * T_world_camera().linear().col(2), box.center());
}

void ViewCamera::Follow(const Eigen::Isometry3d& T_world_sensor, double since_s) {
    const Eigen::Vector3d sensor = T_world_sensor.translation(),
                          forward = T_world_sensor.linear().col(2);
    const Eigen::Vector3d wanted_eye = sensor + follow_scale_ * (0.7 * up_ - 1.1 * forward);
    Approach(wanted_eye, sensor + 1.0 * forward, since_s);
}

void ViewCamera::FollowInside(const Eigen::Isometry3d& T_world_sensor, double since_s) {
    const Eigen::Vector3d sensor = T_world_sensor.translation(),
                          forward = T_world_sensor.linear().col(2);
    Approach(sensor, sensor + 1.0 * forward, since_s);
}

void ViewCamera::Approach(const Eigen::Vector3d& wanted_eye, const Eigen::Vector3d& wanted_target,
                          double since_s) {
    const double part = since_s < 0 ? 1 : 1 - std::exp(-since_s / 0.3);
    const Eigen::Vector3d from = eye();
    Place(from + part * (wanted_eye - from), target_ + part * (wanted_target - target_));
}

Eigen::Vector3d ViewCamera::LevelDirection() const {
    return std::cos(azimuth_rad_) * east_ + std::sin(azimuth_rad_) * north_;
}

Eigen::Vector3d ViewCamera::eye() const {
    return target_ + distance_m_ * (std::cos(elevation_rad_) * LevelDirection() +
                                    std::sin(elevation_rad_) * up_);
}

Eigen::Isometry3d ViewCamera::T_world_camera() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d at = eye(), forward = (target_ - at).normalized();
    T.linear().col(0) = forward.cross(up_).normalized();
    T.linear().col(1) = forward.cross(T.linear().col(0));
    T.linear().col(2) = forward;
    T.translation() = at;
    return T;
}

double ScaleBarLength_m(double most_m) {
    if (!(most_m > 0)) return 0;
    const double power = std::pow(10.0, std::floor(std::log10(most_m)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= most_m) return factor * power;
    return power;
}

PinholeCamera ViewCamera::Camera(int width, int height) {
    const double focal = height / (2 * std::tan(kHeightRad / 2));
    return {width, height, focal, focal, (width - 1) / 2.0, (height - 1) / 2.0};
}

}  // namespace tessera
