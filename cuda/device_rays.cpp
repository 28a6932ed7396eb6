#include "cuda/device_rays.h"

#include "core/scalar_lanes.h"
#include "cuda/device_loops.h"
#include "mapping/ray_kernels.h"

namespace tessera::TESSERA_DEVICE {

namespace ray_bodies {

// Per tile.
struct ClearRange {
    RayRange nothing;
    RayRange* ranges;

    TESSERA_HD_MEMBER void operator()(int i) const { ranges[i] = nothing; }
};

// Per block except the unknown one. Minimum and maximum do not depend on the order.
struct WidenRanges {
    RangeArguments arguments;
    const std::int32_t* coords;
    RayRange* ranges;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int32_t* at = coords + 4 * static_cast<std::int64_t>(i + 1);
        const BlockCoord c{at[0], at[1], at[2]};
        BlockReach reach;
        const bool counts = arguments.all_regions || arguments.regions.Has(RegionOf(c));
        if (!counts || !ReachOf(arguments, c, reach)) return;
        for (int y = reach.lines.first; y <= reach.lines.last; ++y)
            for (int x = reach.columns.first; x <= reach.columns.last; ++x) {
                RayRange& range = ranges[y * arguments.width + x];
                AtomicMin(&range.first_m, reach.range.first_m);
                AtomicMax(&range.last_m, reach.range.last_m);
            }
    }
};

// Per pixel, tile by tile, so that the rays of neighbouring threads meet the same blocks.
struct CastPixel {
    RayArguments arguments;
    const RayRange* ranges;
    std::int32_t tiles_per_row;

    TESSERA_HD_MEMBER void operator()(int i) const {
        using Kernels = RayKernels<ScalarLanes, HashedBlocks<ScalarLanes>>;
        const int tile = i / (kRayTilePx * kRayTilePx), x = i % kRayTilePx,
                  y = i / kRayTilePx % kRayTilePx;
        const int u = tile % tiles_per_row * kRayTilePx + x,
                  v = tile / tiles_per_row * kRayTilePx + y;
        if (u >= arguments.width || v >= arguments.height) return;
        Kernels::Walker walker(arguments);
        Kernels::CastPixels(arguments, walker,
                            {u, u + 1, v, v + 1, ranges[tile].first_m, ranges[tile].last_m}, u, v);
    }
};

// Per pixel.
struct TrustIntensity {
    ModelImages view;
    float jump_m;
    float* intensity;

    TESSERA_HD_MEMBER void operator()(int i) const {
        intensity[i] = view.TrustedIntensity(i % view.width, i / view.width, jump_m);
    }
};

// Per pixel of the coarse image.
struct HalvePixel {
    ModelImages fine;
    float jump_m;
    std::int32_t width;
    float *depth_m, *normal, *intensity;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const ModelPixel pixel = fine.Halved(i % width, i / width, jump_m);
        depth_m[i] = pixel.depth_m;
        for (int k = 0; k < 3; ++k) normal[3 * i + k] = pixel.normal[k];
        intensity[i] = pixel.intensity;
    }
};

}  // namespace ray_bodies

void FindRayRanges(Stream& stream, const RangeArguments& a, const std::int32_t* coords,
                   std::int32_t blocks, RayRange* ranges) {
    ForEach(stream, a.width * a.height,
            ray_bodies::ClearRange{{a.max_depth_m, a.min_depth_m}, ranges});
    ForEach(stream, blocks - 1, ray_bodies::WidenRanges{a, coords, ranges});
}

void CastRays(Stream& stream, const RayArguments& a, const RayRange* ranges) {
    const std::int32_t columns = (a.width + kRayTilePx - 1) / kRayTilePx,
                       rows = (a.height + kRayTilePx - 1) / kRayTilePx;
    ForEach(stream, columns * rows * kRayTilePx * kRayTilePx,
            ray_bodies::CastPixel{a, ranges, columns});
}

void TrustIntensities(Stream& stream, const ModelImages& view, float jump_m, float* intensity) {
    ForEach(stream, view.width * view.height, ray_bodies::TrustIntensity{view, jump_m, intensity});
}

void HalveModel(Stream& stream, const ModelImages& fine, float jump_m, float* depth_m,
                float* normal, float* intensity) {
    const std::int32_t width = fine.width / 2, height = fine.height / 2;
    ForEach(stream, width * height,
            ray_bodies::HalvePixel{fine, jump_m, width, depth_m, normal, intensity});
}

}  // namespace tessera::TESSERA_DEVICE
