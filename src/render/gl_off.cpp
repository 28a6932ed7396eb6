// Stubs that replace everything that needs OpenGL in a build without libepoxy. They report this.
#include "render/gl_context.h"
#include "render/mesh_rasteriser.h"

namespace tessera {
namespace {

Status Off() {
    return Status::Error(
        "this build has no OpenGL support: install libepoxy-dev and build Tessera again");
}

}  // namespace

Result<std::unique_ptr<GlContext>> GlContext::Create() { return Off(); }
GlContext::~GlContext() = default;

struct MeshRasteriser::Impl {};
Result<std::unique_ptr<MeshRasteriser>> MeshRasteriser::Create(const MeshConfig&, LabelVertex) {
    return Off();
}
MeshRasteriser::~MeshRasteriser() = default;
// Never called: no object exists.
void MeshRasteriser::Predict(const BlockMap&, const PinholeCamera&, const Eigen::Isometry3d&, float,
                             float, PredictedView& view) {
    view.SetNothing();
}
const Status& MeshRasteriser::status() const {
    static const Status status = Off();
    return status;
}
const Image<std::uint16_t>& MeshRasteriser::labels() const {
    static const Image<std::uint16_t> labels;
    return labels;
}
void MeshRasteriser::LabelAgain(std::span<const BlockId>) {}
MeshRasteriser::Timings MeshRasteriser::TakeTimings() { return {}; }
std::string MeshRasteriser::renderer() const { return {}; }
std::size_t MeshRasteriser::bytes() const { return 0; }

}  // namespace tessera
