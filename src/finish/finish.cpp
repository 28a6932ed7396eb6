#include "finish/finish.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/depth_noise.h"
#include "finish/decimate.h"
#include "finish/nearest_depth.h"
#include "finish/smooth.h"
#include "finish/texture_baker.h"
#include "finish/view_choice.h"

namespace tessera {
namespace {

// A vertex for each chart that it lies in.
TexturedMesh SplitByChart(const TriangleMesh& mesh, const std::vector<Chart>& charts,
                          const Atlas& atlas) {
    TexturedMesh split;
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> number_of(mesh.vertices.size(), kNone), used;
    const Eigen::Array2f size(static_cast<float>(atlas.width), static_cast<float>(atlas.height));
    for (std::size_t i = 0; i < charts.size(); ++i) {
        for (const std::uint32_t t : charts[i].triangles) {
            auto triangle = mesh.triangles[t];
            for (std::uint32_t& vertex : triangle) {
                std::uint32_t& number = number_of[vertex];
                if (number == kNone) {
                    number = static_cast<std::uint32_t>(split.uv.size());
                    used.push_back(vertex);
                    split.mesh.vertices.push_back(mesh.vertices[vertex]);
                    split.mesh.normals.push_back(mesh.normals[vertex]);
                    const Eigen::Vector2f texel =
                        atlas.TexelOf(charts[i], i, mesh.vertices[vertex]);
                    split.uv.emplace_back((texel.array() + 0.5f) / size);
                }
                vertex = number;
            }
            split.mesh.triangles.push_back(triangle);
        }
        for (const std::uint32_t vertex : used) number_of[vertex] = kNone;
        used.clear();
    }
    return split;
}

// Makes charts smaller whose texels would be narrower than the nearest view's pixels.
void FitToPixels(const TriangleMesh& mesh, const PinholeCamera& camera,
                 std::span<const StampedPose> path, double texel_m, std::vector<Chart>& charts) {
    const std::vector<float> depths_m = NearestDepths_m(mesh, camera, path);
    for (Chart& chart : charts) {
        float nearest_m = std::numeric_limits<float>::infinity();
        for (const std::uint32_t t : chart.triangles)
            for (const std::uint32_t v : mesh.triangles[t])
                nearest_m = std::min(nearest_m, depths_m[v]);
        const double pixel_m = static_cast<double>(nearest_m) / camera.fx;
        if (pixel_m > texel_m) chart.Shrink(static_cast<float>(texel_m / pixel_m));
    }
}

// The noise of a mean falls with the root of what is averaged.
std::vector<int> RoundsOf(const std::vector<float>& sigmas_m, int rounds) {
    std::vector<int> of_vertex;
    of_vertex.reserve(sigmas_m.size());
    for (const float sigma_m : sigmas_m) {
        const float relative = sigma_m / 0.002f;
        of_vertex.push_back(static_cast<int>(
            std::lround(std::min(relative * relative, 20.0f) * static_cast<float>(rounds))));
    }
    return of_vertex;
}

}  // namespace

Result<FinishedModel> FinishModel(TriangleMesh mesh, const PinholeCamera& camera,
                                  std::span<const StampedPose> path, const NextPosedFrame& next,
                                  std::int64_t frames, const FinishOptions& options,
                                  const FinishProgress& progress) {
    const Status cancelled = Status::Error("cancelled");
    FinishedModel finished;
    FinishReport& report = finished.report;
    report.triangles_before = mesh.triangles.size();
    if (mesh.normals.size() != mesh.vertices.size())
        return Status::Error("the mesh has no normals; repeat the run");
    const bool has_colours = !mesh.colours.empty();
    if (!has_colours) mesh.colours.assign(mesh.vertices.size(), Rgb8{180, 180, 180});
    const TriangleMesh scanned = mesh;  // its colours are the reference of the gains
    report.islands = RemoveIslands(mesh, options.least_island_m2);
    if (mesh.triangles.empty()) return Status::Error("the mesh has no triangles");
    const std::vector<float> depths_m = NearestDepths_m(mesh, camera, path);
    std::vector<float> sigmas_m(depths_m.size());
    std::ranges::transform(depths_m, sigmas_m.begin(), DepthSigma_m);
    Smooth(mesh, RoundsOf(sigmas_m, options.smoothing_rounds));
    if (!progress("cleaned", 0.05)) return cancelled;

    if (options.decimation_error_m > 0 && options.decimation_share < 1)
        report.decimation_error_m =
            Decimate(mesh, sigmas_m, options.decimation_error_m, options.decimation_share);
    if (!progress("simplified", 0.1)) return cancelled;

    std::vector<Chart> charts = CutCharts(mesh, {.cell_m = options.texel_m});
    FitToPixels(mesh, camera, path, options.texel_m, charts);
    const Result<Atlas> atlas = PackCharts(charts, options.texel_m, options.texture_side);
    if (!atlas.ok()) return atlas.status();
    report.charts = charts.size();
    report.texel_m = atlas.value().texel_m;
    if (!progress("laid out", 0.15)) return cancelled;

    TextureBaker baker(mesh, charts, atlas.value());
    const auto bake = [&](const std::optional<Frame>& frame) {
        if (!frame) return;
        TextureView view = MakeTextureView(camera, *frame);
        view.blur_px = MotionBlur_px(path, frame->stamp_s, camera);
        if (has_colours) EstimateGain(scanned, view);
        baker.Add(view);
        ++report.views;
    };
    ViewChoice choice;
    for (Frame frame; next(frame); ++report.frames) {
        if (frame.T_world_camera && !frame.colour.empty()) bake(choice.Offer(frame));
        const double read = static_cast<double>(report.frames + 1) /
                            static_cast<double>(std::max<std::int64_t>(frames, 1));
        if (!progress("textured", 0.15 + 0.85 * std::min(read, 1.0))) return cancelled;
    }
    bake(choice.Last());
    report.seen_share = baker.SeenShare();
    finished.model = SplitByChart(mesh, charts, atlas.value());
    finished.model.texture = baker.Texture();
    return finished;
}

}  // namespace tessera
