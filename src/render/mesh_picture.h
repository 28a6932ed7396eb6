// Pictures of meshes without OpenGL: ray casting on the CPU, for a run's preview and for `tessera
// render`. Uses all cores (TBB).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "io/textured_mesh.h"

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
        kColour,     // vertex colours, unlit; shaded where the mesh has none
        kLitColour,  // the same, lit a little from the camera: for non-photographic colours
        kNormal,     // the normal's x, y, z in the world frame as red, green, blue
        kShaded,     // grey, lit from the camera
    };
    Shading shading = Shading::kColour;
    // Leaves out triangles seen from behind, so that a room seen from outside shows its inside.
    bool cull_back_faces = true;
    Rgb8 background_top{240, 243, 247}, background_bottom{200, 207, 218};
    // Camera poses (T_world_camera) of a run, drawn over the picture as a line with camera frustums
    // along it.
    std::vector<Eigen::Isometry3d> path;
    Rgb8 path_colour{214, 72, 32};
    double frustum_m = 0;         // depth of the frustums; 0 chooses it from the picture
    std::vector<NamedBox> boxes;  // drawn over the picture, never occluded, with their names
};

// Renders the mesh as `camera` at T_world_camera sees it, with 2 x 2 samples per pixel and no near
// or far limit. Uses the mesh's normals, or those of the triangles if it has none. Thread-safe.
ColourImage RenderMesh(const TriangleMesh& mesh, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const RenderStyle& style = {});

// The same of a textured mesh: its texture in place of vertex colours.
ColourImage RenderTextured(const TexturedMesh& model, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_world_camera, const RenderStyle& style = {});

struct MeshView {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

// Chooses a view of the whole mesh, except a few outliers, and of the path (any number of
// T_world_camera). It looks from behind and above the path's cameras, in their viewing direction.
// Without a path, it looks at the side that most surfaces face; up is then +z if more surface faces
// it than -z, else -y (the first camera's up). `width` and `height` are in pixels; the view is 50
// degrees wide. Thread-safe, deterministic.
MeshView ChooseView(const TriangleMesh& mesh, std::span<const Eigen::Isometry3d> path = {},
                    int width = 1280, int height = 960);

}  // namespace tessera
