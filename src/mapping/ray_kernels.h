// Renders the pixels of a predicted view: casts one ray each and computes depth, normal and colour
// at its surface point. Works on lanes of pixels (scalar_lanes.h), for the CPU's SIMD kernels and
// CUDA.
#pragma once

#include <cstddef>

#include "mapping/ray_walk.h"

namespace tessera {

template <class V, class Blocks>
class RayKernels {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;
    using Walker = RayWalker<V, Blocks>;

    // Casts the rays of the pixels [u, u + V::kCount) of row v that lie in the tile, and writes the
    // results.
    TESSERA_HD_MEMBER static void CastPixels(const RayArguments& a, Walker& walker,
                                             const RayTile& tile, int u, int v) {
        const int count = V::kCount < tile.u_end - u ? V::kCount : tile.u_end - u;
        const Rays rays = RaysThrough(a, Real(static_cast<float>(u)) + V::Numbers(), v);
        const Mask used = V::Numbers() < Real(static_cast<float>(count));
        const Hits hits = walker.FirstSurface(rays, used, tile.first_m, tile.last_m);
        Pixels pixels;
        Shade(a, walker, rays, hits, pixels);
        Write(a, pixels, u, v, count);
    }

  private:
    using Rays = typename Walker::Rays;
    using Cells = typename Walker::Cells;
    using Hits = typename Walker::Hits;

    struct Appearance {
        Real intensity;  // -1 where none
        Real rgb[3];     // 0 to 1
    };

    // Interpolates luma and chroma over the corners that have an intensity, then converts once.
    TESSERA_HD_MEMBER static Appearance InterpolateColour(const RayArguments& a, const Int* index,
                                                          const Int* words, const Real* fraction) {
        Real total(0.0f), y(0.0f), cb(0.0f), cr(0.0f);
        for (int c = 0; c < 8; ++c) {
            Real w(1.0f);
            for (int k = 0; k < 3; ++k)
                w = w * (c >> k & 1 ? fraction[k] : Real(1.0f) - fraction[k]);
            const Int intensity = words[c] & Int(0xffff);
            w = V::Select(V::ToMask(intensity != Int(0)), w, Real(0.0f));
            const Int chroma = V::AsInt(V::Gather(a.colour, index[c]));
            total = total + w;
            y = y + w * V::ToReal(intensity);
            cb = cb + w * V::ToReal(chroma & Int(1023));
            cr = cr + w * V::ToReal((chroma >> 10) & Int(1023));
        }
        const Mask coloured = total >= Real(1e-3f);
        const Real scale = Real(1.0f) / V::Select(coloured, total, Real(1.0f));
        Appearance result;
        const Real intensity = (y * scale - Real(1.0f)) * Real(1.0f / kIntensitySteps);
        RgbFromParts(intensity, cb * scale, cr * scale, result.rgb);
        result.intensity = V::Select(coloured, intensity, Real(-1.0f));
        for (Real& channel : result.rgb)
            channel = V::Select(coloured, channel, Real(128.0f / 255.0f));
        return result;
    }

    TESSERA_HD_MEMBER static void Rotate(const float* rotation, const Real* v, Real* rotated) {
        for (int k = 0; k < 3; ++k) {
            const float* r = rotation + 3 * k;
            rotated[k] = Real(r[0]) * v[0] + Real(r[1]) * v[1] + Real(r[2]) * v[2];
        }
    }

    // The results of one packet of pixels, lane by lane.
    struct Pixels {
        alignas(64) float depth_m[V::kCount], intensity[V::kCount], normal[3][V::kCount],
            rgb[3][V::kCount];
    };

    TESSERA_HD_MEMBER static void Shade(const RayArguments& a, Walker& walker, const Rays& rays,
                                        const Hits& hits, Pixels& pixels) {
        const Cells cells = walker.Locate(rays, hits.depth_m, hits.found);
        Int index[8], words[8];
        BlockKernels<V>::CornerVoxels(a, cells.block, cells.voxel, index);
        Real corner[8];
        for (int c = 0; c < 8; ++c) {
            words[c] = V::AsInt(V::Gather(a.field, index[c]));
            corner[c] = V::ToReal(words[c] >> 16);
        }
        const auto distance =
            Trilinear(corner, cells.fraction[0], cells.fraction[1], cells.fraction[2]);
        const Real gradient[3] = {distance.gx, distance.gy, distance.gz};
        Real normal[3];
        Rotate(a.camera_from_world, gradient, normal);
        const Real length2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        const Real none(0.0f);
        const Real scale = Real(1.0f) / V::Sqrt(V::Select(length2 > none, length2, Real(1.0f)));
        const Appearance look = InterpolateColour(a, index, words, cells.fraction);
        V::Store(V::Select(hits.found, hits.depth_m, none), pixels.depth_m);
        V::Store(V::Select(hits.found, look.intensity, none), pixels.intensity);
        for (int k = 0; k < 3; ++k) {
            V::Store(V::Select(hits.found, normal[k] * scale, none), pixels.normal[k]);
            V::Store(V::Select(hits.found, look.rgb[k] * Real(255.0f) + Real(0.5f), none),
                     pixels.rgb[k]);
        }
    }

    TESSERA_HD_MEMBER static void Write(const RayArguments& a, const Pixels& pixels, int u, int v,
                                        int count) {
        const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(a.width);
        for (int i = 0; i < count; ++i) {
            const std::size_t at = row + static_cast<std::size_t>(u + i);
            a.depth_m[at] = pixels.depth_m[i];
            a.intensity[at] = pixels.intensity[i];
            for (std::size_t k = 0; k < 3; ++k) {
                a.normal_camera[3 * at + k] = pixels.normal[k][i];
                a.rgb[3 * at + k] = static_cast<std::uint8_t>(pixels.rgb[k][i]);
            }
        }
    }

    TESSERA_HD_MEMBER static Rays RaysThrough(const RayArguments& a, const Real& u, int v) {
        const Real camera[3] = {(u - Real(a.cx)) / Real(a.fx),
                                Real((static_cast<float>(v) - a.cy) / a.fy), Real(1.0f)};
        Rays rays;
        Rotate(a.voxel_from_camera, camera, rays.step);
        Real length2(0.0f);
        for (int k = 0; k < 3; ++k) {
            const Real& step = rays.step[k];
            length2 = length2 + step * step;
            const Real parallel(1e30f);  // parallel to this axis' faces: never meets them
            rays.inverse_step[k] = V::Select(step == Real(0.0f), parallel, Real(1.0f) / step);
        }
        rays.metres_per_voxel = Real(1.0f) / V::Sqrt(length2);
        return rays;
    }
};

}  // namespace tessera
