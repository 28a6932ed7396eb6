// Predicted views of the map by rasterising its mesh, [D18] section 3.2: marching cubes, drawn by
// OpenGL with the camera's intrinsics, depth buffer read back. Needs no window.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "mapping/block_mesh.h"
#include "mapping/predicted_view.h"

namespace tessera {

// One thread at a time. Meshes and uploads only what has changed since its last view; so whoever
// writes the map must use a new revision after each Predict (Integrator does). Another map, or one
// that was cleared, is taken up from scratch. The same bytes for any number of threads.
class MeshRasteriser : public ViewPredictor {
  public:
    // Of the last Predict. What is drawn may still be under way when draw_ms ends; read_back_ms
    // waits for it.
    struct Timings {
        double mesh_ms = 0, upload_ms = 0, draw_ms = 0, read_back_ms = 0;
    };

    // Of `config` only min_weight counts: small pieces are drawn too, as they are ray cast. Fails
    // with one line where the build or the machine has no OpenGL 3.3 through EGL.
    static Result<std::unique_ptr<MeshRasteriser>> Create(const MeshConfig& config);
    ~MeshRasteriser() override;

    // As ViewPredictor says. Leaves the calling thread's OpenGL context as it was.
    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& view) override;

    // Why the last Predict showed nothing, if the driver could not draw it (a camera too large, no
    // memory).
    const Status& status() const;
    const Timings& timings() const;
    std::string renderer() const;  // as GlContext::renderer
    std::size_t bytes() const;     // mesh memory, here and on the card

  private:
    struct Impl;
    explicit MeshRasteriser(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
