#include "finish/textured_level.h"

#include <algorithm>
#include <limits>

#include "finish/nearest_depth.h"

namespace tessera {
namespace {

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

}  // namespace

Result<TexturedLevel> TexturedLevel::Make(TriangleMesh mesh, const PinholeCamera& camera,
                                          std::span<const StampedPose> path,
                                          const LevelOptions& options, LevelReport& report) {
    std::vector<Chart> charts = CutCharts(mesh, {.cell_m = options.texel_m});
    FitToPixels(mesh, camera, path, options.texel_m, charts);
    Result<Atlas> atlas = PackCharts(charts, options.texel_m, options.texture_side);
    if (!atlas.ok()) return atlas.status();
    report.triangles = mesh.triangles.size();
    report.charts = charts.size();
    report.texel_m = atlas.value().texel_m;
    return TexturedLevel(std::move(mesh), std::move(charts), std::move(atlas.value()));
}

TexturedMesh TexturedLevel::Finish(LevelReport& report) const {
    TexturedMesh model = SplitByChart(mesh_, charts_, atlas_);
    model.texture = baker_.Texture();
    report.width = model.texture.width();
    report.height = model.texture.height();
    report.seen_share = baker_.SeenShare();
    return model;
}

}  // namespace tessera
