// Predicts views of the map by rasterising its mesh ([D18] section 3.2): OpenGL draws the marching
// cubes mesh with the camera's intrinsics, and the depth buffer is read back. The same draw gives
// an image of labels ([D18] 3.4, figure 8). Needs no window.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/status.h"
#include "mapping/block_mesh.h"
#include "mapping/predicted_view.h"

namespace tessera {

// For one thread at a time. Meshes and uploads only what has changed since its last view. So the
// writer of the map must use a new revision after each Predict (Integrator does). Starts from
// scratch for another map or a cleared one. Gives the same bytes for any number of threads.
class MeshRasteriser : public ViewPredictor {
  public:
    // Drawing may still be in progress when draw_ms ends; read_back_ms includes the wait.
    struct Timings {
        double mesh_ms = 0, upload_ms = 0, draw_ms = 0, read_back_ms = 0;
    };
    // Returns the label of a vertex of `owner`, which was meshed from `map`; 0: none. Called from
    // many threads at once.
    using LabelVertex = std::function<std::uint16_t(const BlockMap& map, const BlockMesh& owner,
                                                    const BlockMesh::Vertex& vertex)>;

    // Uses only min_weight of `config`: small components are drawn too, as in ray casting. With
    // `label` it also draws labels. Fails with a one-line error if the build or the machine has no
    // OpenGL 3.3 through EGL.
    static Result<std::unique_ptr<MeshRasteriser>> Create(const MeshConfig& config,
                                                          LabelVertex label = {});
    ~MeshRasteriser() override;

    // See ViewPredictor. Restores the calling thread's OpenGL context.
    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& view) override;
    // With `label` only: the labels that the last view shows, 0 where there is no surface. A
    // triangle has the label of one of its vertices.
    const Image<std::uint16_t>& labels() const;
    // Call when the labels of these blocks' voxels have changed, whether their surface has or not.
    // The next Predict labels them, and no others, again.
    void LabelAgain(std::span<const BlockId> blocks);

    // The error if the driver could not draw the last view (camera too large, out of memory). The
    // view is then empty.
    const Status& status() const;
    // Sums over the views since the last call.
    Timings TakeTimings();
    std::string renderer() const;  // see GlContext::renderer
    std::size_t bytes() const;     // mesh memory, CPU and GPU

  private:
    struct Impl;
    explicit MeshRasteriser(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
