// Makes a camera path for a model without one: around a small object, or turning on the spot inside
// a building.
#pragma once

#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

// `up`: unit vector along one of the axes. Deterministic.
CameraPath MakeModelPath(const Scene& scene, const Eigen::Vector3d& up);

}  // namespace tessera
