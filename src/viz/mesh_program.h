// Shader of the mesh in the 3D view. Made, used and destroyed with the OpenGL context current.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/status.h"
#include "render/gl_program.h"
#include "viz/coverage.h"
#include "viz/viewer_state.h"

namespace tessera {

class MeshProgram {
  public:
    static Result<MeshProgram> Create();

    struct Look {
        Shading shading = Shading::kColour;
        CoverageLevels levels;
        // Where its product with a point is negative, the surface is hidden. Has an effect while
        // GL_CLIP_DISTANCE0 is enabled.
        Eigen::Vector4d cut_in_clip_space = Eigen::Vector4d::Zero();
    };
    // Activates the program for this camera. `up`: unit vector in the world frame.
    void Use(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
             const Eigen::Vector3d& up, const Look& look) const;
    // Uniform location, for GlMeshStore::Draw.
    int clip_from_position() const { return program_.Location("clip_from_position"); }

  private:
    explicit MeshProgram(GlProgram program) : program_(std::move(program)) {}
    GlProgram program_;
};

}  // namespace tessera
