// Where a person looks at the map from: around a point, or behind the sensor. Pure calculation,
// owner thread only.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"

namespace tessera {

class ViewCamera {
  public:
    // `up` is the world's, any length but 0.
    explicit ViewCamera(const Eigen::Vector3d& up = {0, -1, 0}) { SetUp(up); }

    // Stays where it is and turns upright.
    void SetUp(const Eigen::Vector3d& up);
    // Looks from `eye` at `target`, metres in the world; these must differ.
    void Place(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

    // Around the target, in radians: the scene follows the pointer.
    void Rotate(double right_rad, double down_rad);
    // Moves scene and target by pixels of a picture that is `height_px` high.
    void Pan(double right_px, double down_px, double height_px);
    // The distance to the target times this factor, within 5 cm to 500 m.
    void Zoom(double factor);
    // Makes this point the target; the direction stays.
    void LookAt(const Eigen::Vector3d& point) { target_ = point; }

    // Goes towards the place behind and above the sensor, most of the way in half a second.
    // `since_s` since the last call; negative: jumps there.
    void Follow(const Eigen::Isometry3d& T_world_sensor, double since_s);

    Eigen::Isometry3d T_world_camera() const;
    // Square pixels, 50 degrees high.
    static PinholeCamera Camera(int width, int height);
    const Eigen::Vector3d& target() const { return target_; }
    Eigen::Vector3d eye() const;
    double distance_m() const { return distance_m_; }
    const Eigen::Vector3d& up() const { return up_; }

  private:
    Eigen::Vector3d up_ = Eigen::Vector3d::Zero(), east_, north_;  // east_ x north_ = up_
    Eigen::Vector3d target_ = Eigen::Vector3d::Zero();
    // Of the eye, seen from the target.
    double distance_m_ = 2, azimuth_rad_ = 0, elevation_rad_ = 0.5;
    double follow_scale_ = 1;
};

}  // namespace tessera
