// A camera motion for a model that brings none: around a small thing, or turning on the spot inside
// a building.
#pragma once

#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

// `up`: unit, one of the axes. Deterministic.
CameraPath MakeModelPath(const Scene& scene, const Eigen::Vector3d& up);

}  // namespace tessera
