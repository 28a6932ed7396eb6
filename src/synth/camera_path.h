// Where the synthetic camera is at each moment: hand-held-like motion made of smooth sweeps and
// tremor, the same on every run. A function of continuous time, so that motion blur can look
// between frames. Thread-safe.
#pragma once

#include <functional>
#include <string>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

struct CameraPath {
    std::function<Eigen::Isometry3d(double)>
        T_world_camera;  // of the time in seconds from the start, any value
    double duration_s = 0;
};

// Camera at `eye` with its z axis through `target`, x level; `up` is the world's upward direction
// and must not be parallel to the view.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

// A hand's shaking about a steady pose: 1 to 2 mm and 0.2 degrees rms below 4 Hz.
Eigen::Isometry3d Tremor(double time_s);

// The same way, so many times as fast.
CameraPath Hastened(CameraPath path, double speed);

// A recorded trajectory from its first pose on, interpolated. With `T_world_start`, moved so that
// it begins there.
Result<CameraPath> ReadCameraPath(const std::string& file,
                                  const Eigen::Isometry3d* T_world_start = nullptr);

}  // namespace tessera
