// Camera of the 3D view: orbits around a point, or stays behind the sensor. Computation only; owner
// thread only.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"

namespace tessera {

class ViewCamera {
  public:
    // `up`: in the world frame, any non-zero length.
    explicit ViewCamera(const Eigen::Vector3d& up = {0, -1, 0}) { SetUp(up); }

    // Keeps the eye in place and turns the view upright.
    void SetUp(const Eigen::Vector3d& up);
    // Looks from `eye` at `target`, in world metres; the two must differ.
    void Place(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

    // Orbits around the target, in radians; the scene follows the mouse.
    void Rotate(double right_rad, double down_rad);
    // First person: turns the view around the eye, in radians.
    void Turn(double right_rad, double down_rad);
    // First person: moves eye and target along the view.
    void Walk(double forward_m);
    // Moves scene and target by pixels of a picture `height_px` high.
    void Pan(double right_px, double down_px, double height_px);
    // Multiplies the distance to the target by this factor, limited to 5 cm to 500 m.
    void Zoom(double factor);
    // Moves so that all of the box is visible, keeping the direction. Small changes of the box move
    // nothing, or the view would never rest while a mesh grows.
    void ShowAll(const Eigen::AlignedBox3d& box);
    // Makes this point the target; the direction does not change.
    void LookAt(const Eigen::Vector3d& point) { target_ = point; }

    // Moves smoothly to a place behind and above the sensor, most of the way within half a second.
    // `since_s`: seconds since the last call; negative: jumps there.
    void Follow(const Eigen::Isometry3d& T_world_sensor, double since_s);

    // The same to the sensor's own place, looking where it looks, upright.
    void FollowInside(const Eigen::Isometry3d& T_world_sensor, double since_s);

    Eigen::Isometry3d T_world_camera() const;
    // Square pixels, 50 degrees vertical field of view.
    static PinholeCamera Camera(int width, int height);
    const Eigen::Vector3d& target() const { return target_; }
    Eigen::Vector3d eye() const;
    // From the target to the eye, without its part along up; unit length.
    Eigen::Vector3d LevelDirection() const;
    double distance_m() const { return distance_m_; }
    // Width of a pixel at the target, in a picture `height_px` high.
    double PixelSize_m(double height_px) const;
    const Eigen::Vector3d& up() const { return up_; }

  private:
    void Approach(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double since_s);

    Eigen::Vector3d up_ = Eigen::Vector3d::Zero(), east_, north_;  // east_ x north_ = up_
    Eigen::Vector3d target_ = Eigen::Vector3d::Zero();
    // Position of the eye, relative to the target.
    double distance_m_ = 2, azimuth_rad_ = 0, elevation_rad_ = 0.5;
    double follow_scale_ = 1;
};

// The largest of 1, 2, 5, 10, ... times a power of ten that is not above `most_m`: the length of a
// scale bar.
double ScaleBarLength_m(double most_m);

}  // namespace tessera
