// A run's path and boxes drawn over a picture. Used by mesh_picture.cpp only.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "render/mesh_picture.h"

namespace tessera {

// Draws style.path as `camera` at T_world_camera sees it, on top of what is there.
void DrawPath(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
              const RenderStyle& style, ColourImage& image);

// Draws style.boxes likewise, their names above them, those of nearer ones on top.
void DrawBoxes(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
               const RenderStyle& style, ColourImage& image);

}  // namespace tessera
