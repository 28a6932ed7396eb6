#include "mapping/ray_rows.h"

#include <algorithm>

#include "core/vector_types.h"
#include "mapping/ray_walk.h"
#include "mapping/trilinear.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {
namespace {

struct Appearance {
    Real intensity;  // -1 where none
    Real rgb[3];     // 0 to 1
};

// Interpolates the words' parts over the corners that have an intensity, then converts once.
[[gnu::always_inline]] inline Appearance InterpolateColour(const RayArguments& a, const Int* index, const Int* words,
                                                           const Real* fraction) {
    Real total(0.0f), y(0.0f), cb(0.0f), cr(0.0f);
    for (int c = 0; c < 8; ++c) {
        Real w(1.0f);
        for (int k = 0; k < 3; ++k) w = w * (c >> k & 1 ? fraction[k] : Real(1.0f) - fraction[k]);
        const Int intensity = words[c] & Int(0xffff);
        w = Select(AsRealMask(intensity != Int(0)), w, Real(0.0f));
        const Int chroma = Gather(reinterpret_cast<const std::int32_t*>(a.colour), index[c]);
        total = total + w;
        y = y + w * xsimd::to_float(intensity);
        cb = cb + w * xsimd::to_float(chroma & Int(1023));
        cr = cr + w * xsimd::to_float((chroma >> 10) & Int(1023));
    }
    const RealMask coloured = total >= Real(1e-3f);
    const Real scale = Real(1.0f) / Select(coloured, total, Real(1.0f));
    Appearance result;
    const Real intensity = (y * scale - Real(1.0f)) * Real(1.0f / kIntensitySteps);
    RgbFromParts(intensity, cb * scale, cr * scale, result.rgb);
    result.intensity = Select(coloured, intensity, Real(-1.0f));
    for (Real& channel : result.rgb) channel = Select(coloured, channel, Real(128.0f / 255.0f));
    return result;
}

[[gnu::always_inline]] inline void Rotate(const float* rotation, const Real* v, Real* rotated) {
    for (int k = 0; k < 3; ++k) {
        const float* r = rotation + 3 * k;
        rotated[k] = Real(r[0]) * v[0] + Real(r[1]) * v[1] + Real(r[2]) * v[2];
    }
}

// What a packet's pixels show, lane by lane.
struct Pixels {
    alignas(64) float depth_m[kLanes], intensity[kLanes], normal[3][kLanes], rgb[3][kLanes];
};

[[gnu::always_inline]] inline void Shade(const RayArguments& a, RayWalker& walker, const Rays& rays,
                                         const Hits& hits, Pixels& pixels) {
    const Cells cells = walker.Locate(rays, hits.depth_m, hits.found);
    Int index[8], words[8];
    CornerVoxels(a, cells.block, cells.voxel, index);
    Real corner[8];
    for (int c = 0; c < 8; ++c) {
        words[c] = Gather(reinterpret_cast<const std::int32_t*>(a.field), index[c]);
        corner[c] = xsimd::to_float(words[c] >> 16);
    }
    const auto distance = Trilinear(corner, cells.fraction[0], cells.fraction[1], cells.fraction[2]);
    const Real gradient[3] = {distance.gx, distance.gy, distance.gz};
    Real normal[3];
    Rotate(a.camera_from_world, gradient, normal);
    const Real length2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    const Real none(0.0f);
    const Real scale = Real(1.0f) / xsimd::sqrt(Select(length2 > none, length2, Real(1.0f)));
    const Appearance look = InterpolateColour(a, index, words, cells.fraction);
    Select(hits.found, hits.depth_m, none).store_aligned(pixels.depth_m);
    Select(hits.found, look.intensity, none).store_aligned(pixels.intensity);
    for (int k = 0; k < 3; ++k) {
        Select(hits.found, normal[k] * scale, none).store_aligned(pixels.normal[k]);
        Select(hits.found, look.rgb[k] * Real(255.0f) + Real(0.5f), none).store_aligned(pixels.rgb[k]);
    }
}

void Store(const RayArguments& a, const Pixels& pixels, int u, int v, int count) {
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(u);
    for (int i = 0; i < count; ++i) {
        const std::size_t at = first + static_cast<std::size_t>(i);
        a.depth_m[at] = pixels.depth_m[i];
        a.intensity[at] = pixels.intensity[i];
        for (std::size_t k = 0; k < 3; ++k) {
            a.normal_camera[3 * at + k] = pixels.normal[k][i];
            a.rgb[3 * at + k] = static_cast<std::uint8_t>(pixels.rgb[k][i]);
        }
    }
}

[[gnu::always_inline]] inline Rays RaysThrough(const RayArguments& a, const Real& u, int v) {
    const Real camera[3] = {(u - Real(a.cx)) / Real(a.fx), Real((static_cast<float>(v) - a.cy) / a.fy), Real(1.0f)};
    Rays rays;
    Rotate(a.voxel_from_camera, camera, rays.step);
    Real length2(0.0f);
    for (int k = 0; k < 3; ++k) {
        const Real& step = rays.step[k];
        length2 = length2 + step * step;
        const Real parallel(1e30f);  // to this axis' sides: never meets them
        rays.inverse_step[k] = Select(step == Real(0.0f), parallel, Real(1.0f) / step);
    }
    rays.metres_per_voxel = Real(1.0f) / xsimd::sqrt(length2);
    return rays;
}

[[gnu::always_inline]] inline void CastPacket(const RayArguments& a, RayWalker& walker, const RayTile& tile, int u,
                                              int v) {
    const int count = std::min(kLanes, tile.u_end - u);
    const Rays rays = RaysThrough(a, Real(static_cast<float>(u)) + LaneNumbers(), v);
    const RealMask used = LaneNumbers() < Real(static_cast<float>(count));
    const Hits hits = walker.FirstSurface(rays, used, tile.first_m, tile.last_m);
    Pixels pixels;
    Shade(a, walker, rays, hits, pixels);
    Store(a, pixels, u, v, count);
}

}  // namespace

void CastTiles(const RayArguments& a, const RayTile* tiles, std::int32_t count) {
    RayWalker walker(a);
    for (std::int32_t i = 0; i < count; ++i)
        for (int v = tiles[i].v_begin; v < tiles[i].v_end; ++v)
            for (int u = tiles[i].u_begin; u < tiles[i].u_end; u += kLanes) CastPacket(a, walker, tiles[i], u, v);
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
