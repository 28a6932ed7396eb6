// Pictures of meshes without OpenGL: ray casting on the processor, for a run's preview and for
// `tessera render`. Uses all cores (TBB).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"

namespace tessera {

// A box with its name, drawn over a picture.
struct NamedBox {
    Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();  // its centre and axes
    Eigen::Vector3d size = Eigen::Vector3d::Zero();                 // metres
    std::string name;                                               // may be empty
    Rgb8 colour;
};

struct RenderStyle {
    enum class Shading {
        kColour,     // the vertices' colours as they are; shaded where the mesh has none
        kLitColour,  // the same, lit a little from the camera: for colours that are no photograph
        kNormal,     // the normal's x, y, z in the world frame as red, green, blue
        kShaded,     // grey, lit from the camera
    };
    Shading shading = Shading::kColour;
    // Triangles seen from behind are left out, so that a room seen from outside shows its inside.
    bool cull_back_faces = true;
    Rgb8 background_top{240, 243, 247}, background_bottom{200, 207, 218};
    // T_world_camera of a run: drawn over the picture as a line with the cameras' outlines along
    // it.
    std::vector<Eigen::Isometry3d> path;
    Rgb8 path_colour{214, 72, 32};
    double frustum_m = 0;         // the outlines' depth; 0 chooses it by the picture
    std::vector<NamedBox> boxes;  // drawn over the picture, edges whole, with their names
};

// The mesh as `camera` at T_world_camera sees it, 2 x 2 samples per pixel, no near or far limit.
// Normals are the mesh's, the triangles' where it has none. Thread-safe.
ColourImage RenderMesh(const TriangleMesh& mesh, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const RenderStyle& style = {});

struct MeshView {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

// A view over the whole mesh, few outliers apart, and the path: from behind and above its cameras,
// in the direction in which they looked. Without a path (T_world_camera, any number) towards the
// side that most surfaces face; up is then +z if more surface faces it than -z, else -y, a first
// camera's. `width` and `height` in pixels, 50 degrees wide. Thread-safe, deterministic.
MeshView ChooseView(const TriangleMesh& mesh, std::span<const Eigen::Isometry3d> path = {},
                    int width = 1280, int height = 960);

}  // namespace tessera
