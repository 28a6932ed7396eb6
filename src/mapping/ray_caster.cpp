#include "mapping/ray_caster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "mapping/ray_simd.h"

namespace tessera {
namespace {

void CopyRowMajor(const Eigen::Matrix3d& matrix, float* out) {
    for (int i = 0; i < 9; ++i) out[i] = static_cast<float>(matrix(i / 3, i % 3));
}

}  // namespace

float FarthestRayDepth(const BlockMap::Config& map, const PinholeCamera& camera) {
    const double reach_m = (kRayReachBlocks - 1) * kBlockSide * map.voxel_size_m;
    double longest = 1;  // length of a ray of unit depth
    for (const int u : {0, camera.width - 1})
        for (const int v : {0, camera.height - 1})
            longest = std::max(longest, camera.Unproject(u, v, 1).norm());
    return static_cast<float>(reach_m / longest);
}

RayArguments MakeRayArguments(const BlockMap::Config& map, const PinholeCamera& camera,
                              const Eigen::Isometry3d& T_world_camera) {
    RayArguments a{};
    a.fx = static_cast<float>(camera.fx);
    a.fy = static_cast<float>(camera.fy);
    a.cx = static_cast<float>(camera.cx);
    a.cy = static_cast<float>(camera.cy);
    // Relative to the camera's block, so that floats stay accurate far from the world's origin.
    const double voxel_m = map.voxel_size_m;
    const Eigen::Vector3d at = T_world_camera.translation() / voxel_m;
    for (int i = 0; i < 3; ++i) {
        a.origin_block[i] = static_cast<std::int32_t>(std::floor(at(i) / kBlockSide));
        a.start[i] =
            static_cast<float>(at(i) - kBlockSide * static_cast<double>(a.origin_block[i]));
    }
    CopyRowMajor(T_world_camera.linear() / voxel_m, a.voxel_from_camera);
    CopyRowMajor(T_world_camera.linear().transpose(), a.camera_from_world);
    a.width = camera.width;
    a.height = camera.height;
    return a;
}

RayArguments RayArgumentsFor(const BlockMap& map, PredictedView& view) {
    RayArguments a = MakeRayArguments(map.config(), view.camera, view.T_world_camera);
    static_cast<BlockMapView&>(a) = map.view();
    a.colour = map.colour(0);
    a.depth_m = view.depth_m.data();
    a.normal_camera = view.normal_camera.data()->data();
    a.rgb = &view.colour.data()->r;
    a.intensity = view.intensity.data();
    return a;
}

RayCaster::RayCaster(VectorPath path) : path_(path) {}

void RayCaster::Predict(const BlockMap& map, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                        float max_depth_m, PredictedView& view) {
    view.Resize(camera, T_world_camera);
    ranges_.Build(map, camera, T_world_camera, min_depth_m,
                  std::min(max_depth_m, FarthestRayDepth(map.config(), camera)));
    const RayArguments arguments = RayArgumentsFor(map, view);
    tbb::parallel_for(0, ranges_.height, [&](int y) { CastRow(arguments, y); });
}

// Casts one row of the tiles of RayRanges. Neighbouring rays read the same blocks.
void RayCaster::CastRow(const RayArguments& arguments, int y) const {
    constexpr int kTile = kRayTilePx;
    std::vector<RayTile> tiles;
    for (int x = 0; x < ranges_.width; ++x) {
        const auto& [first_m, last_m] =
            ranges_.ranges[static_cast<std::size_t>(y * ranges_.width + x)];
        tiles.push_back({x * kTile, std::min((x + 1) * kTile, arguments.width), y * kTile,
                         std::min((y + 1) * kTile, arguments.height), first_m, last_m});
    }
    TESSERA_SIMD(path_, CastTiles)(arguments, tiles.data(), ranges_.width);
}

}  // namespace tessera
