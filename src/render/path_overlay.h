// A run's path and boxes drawn over a picture. Used by mesh_picture.cpp only.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "render/mesh_picture.h"

namespace tessera {

// Draws style.path over the image, as `camera` at T_world_camera sees it.
void DrawPath(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
              const RenderStyle& style, ColourImage& image);

// Draws style.boxes likewise, with their names above them. Names of nearer boxes are on top.
void DrawBoxes(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
               const RenderStyle& style, ColourImage& image);

}  // namespace tessera
