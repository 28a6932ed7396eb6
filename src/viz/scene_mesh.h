// What the 3D view shows of the surface: the meshes of a running system as they arrive, or one
// finished mesh. Made, used and destroyed with the OpenGL context current.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "render/gl_mesh_store.h"
#include "render/gl_triangle_mesh.h"
#include "viz/coverage.h"
#include "viz/surface_bounds.h"
#include "viz/up_estimator.h"
#include "viz/viewer.h"

namespace tessera {

class SceneMesh {
  public:
    explicit SceneMesh(const CoverageLevels& levels)
        : levels_(levels), surface_(std::make_unique<Surface>(levels)) {}

    // Shows a model instead of the link's meshes. `up`: roughly, in the world frame.
    void SetModel(const ViewedModel& model, const Eigen::Vector3d& up);
    // Takes mesh updates from the link and uploads about `most_bytes` of them at most; the rest
    // stays queued. Where the map was replaced, the surface before is shown until all of the new
    // one is here. True if anything arrived.
    bool Take(ViewerLink& link, std::size_t most_bytes);
    bool is_final() const { return is_final_; }  // the run has ended, and all of its mesh is here
    // `location`: of the uniform clip_from_position.
    void Draw(const Eigen::Matrix4d& clip, const Eigen::Isometry3d& T_world_view, int location);

    const SurfaceBounds& bounds() const { return shown().bounds; }
    // Empty while too few surfaces agree.
    std::optional<Eigen::Vector3d> Up() const { return shown().up.Up(); }
    const Coverage& coverage() const { return shown().coverage; }  // of the meshes from the link
    std::size_t triangles() const { return shown().store.triangles() + model_.triangles(); }

  private:
    struct Surface {
        explicit Surface(const CoverageLevels& levels) : coverage(levels) {}

        GlMeshStore store;
        SurfaceBounds bounds;
        UpEstimator up{{0, -1, 0}};
        Coverage coverage;
    };

    const Surface& shown() const { return before_ ? *before_ : *surface_; }
    bool NextUpdate(ViewerLink& link);
    std::size_t Upload(std::size_t most_bytes);

    CoverageLevels levels_;
    std::unique_ptr<Surface> surface_;  // never null
    std::unique_ptr<Surface> before_;   // of the map before; null once the new one is here
    GlTriangleMesh model_;
    MeshUpdate pending_;
    std::size_t pending_done_ = 0;
    bool is_final_ = false;
};

}  // namespace tessera
