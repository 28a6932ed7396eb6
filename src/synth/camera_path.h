// Path of the synthetic camera. Imitates a hand-held camera with smooth sweeps and tremor;
// deterministic. A function of continuous time, so that motion blur can sample between frames.
// Thread-safe.
#pragma once

#include <functional>
#include <string>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

struct CameraPath {
    // Argument: seconds from the start, any value.
    std::function<Eigen::Isometry3d(double)> T_world_camera;
    double duration_s = 0;
};

// Camera at `eye` with its z axis through `target` and a level x axis. `up` is the world's up
// direction and must not be parallel to the view.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

// Tremor of a hand about a fixed pose: 1 to 2 mm and 0.2 degrees rms below 4 Hz.
Eigen::Isometry3d Tremor(double time_s);

// Returns the same path, `speed` times as fast.
CameraPath SpedUp(CameraPath path, double speed);

// Reads a trajectory and interpolates it, starting at its first pose. With `T_world_start`,
// transforms it so that it starts there.
Result<CameraPath> ReadCameraPath(const std::string& file,
                                  const Eigen::Isometry3d* T_world_start = nullptr);

}  // namespace tessera
