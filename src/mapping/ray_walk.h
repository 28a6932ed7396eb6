// Walking rays through the map, one per lane, to the first surface seen from the front. Included only by ray_rows.cpp.
// How: far from the surface by steps of the stored distance, near it by the interpolated one; through unknown blocks to
// their end; a lane that has met a sign change waits until all have or have left the map, and then the zeros are
// refined together.
#pragma once

#include <cstdint>
#include <limits>

#include "mapping/block_rows.h"
#include "mapping/ray_rows.h"
#include "mapping/trilinear.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

// All lengths below are in voxels, depths along the camera's z apart, which are in metres.
inline constexpr float kNear = 1.5f;    // interpolated from here on; farther off the nearest voxel will do
inline constexpr float kExact = 1e-3f;  // what is that near to zero is the surface
inline constexpr int kRefinements = 12;

// One ray per lane by depth z: p(z) = start + z * step.
struct Rays {
    Real step[3], inverse_step[3];
    Real metres_per_voxel;  // of z: 1 / |step|
};

// The eight voxels around a point.
struct Cells {
    Int block;     // of the lowest corner, 0 if the map does not have it
    Int voxel[3];  // the lowest corner
    Real fraction[3];
};

struct Hits {
    RealMask found;
    Real depth_m;
};

// Walks packets of rays, best neighbouring ones.
class RayWalker {
  public:
    explicit RayWalker(const RayArguments& a)
        : a_(a),
          to_voxels_(a.truncation_m / (kDistanceSteps * a.voxel_size_m)),
          range_(0.99f * a.truncation_m / a.voxel_size_m) {
        static_assert(BlockCache::kReachBlocks == kRayReachBlocks);
    }

    // Of the `walking` lanes, between two depths.
    Hits FirstSurface(const Rays& rays, RealMask walking, float first_m, float last_m) {
        Hits hits{RealMask(false), Real(0.0f)};
        Walk w{walking, RealMask(false), RealMask(false), Real(first_m), Real(0.0f),
               Real(0.0f), Real(0.0f), Real(0.0f)};
        const Real last(last_m);
        for (;;) {
            w.walking = w.walking & (w.z <= last);
            // A lane that has crossed waits for the others: refined together they cost as much as one.
            while (xsimd::any(w.walking)) {
                Advance(rays, w);
                w.walking = w.walking & (w.z <= last);
            }
            if (!xsimd::any(w.crossed)) return hits;
            const Hits refined = Refine(rays, w);
            hits.found = hits.found | refined.found;
            hits.depth_m = Select(refined.found, refined.depth_m, hits.depth_m);
            w.walking = w.crossed & ~refined.found;
            w.z = Select(w.walking, w.z + w.advance * rays.metres_per_voxel, w.z);
            w.crossed = RealMask(false);
        }
    }

    // The cells at depth z; blocks only of the wanted lanes.
    [[gnu::always_inline]] Cells Locate(const Rays& rays, const Real& z, const RealMask& wanted) {
        Cells cells;
        Int block[3];
        for (int k = 0; k < 3; ++k) {
            const Real p = Real(a_.start[k]) + z * rays.step[k];
            const Real lower = xsimd::floor(p);
            cells.voxel[k] = xsimd::to_int(lower);
            cells.fraction[k] = p - lower;
            block[k] = cells.voxel[k] >> 3;
        }
        cells.block = cache_.Find(a_, block, wanted);
        return cells;
    }

  private:
    // Where each lane has come to.
    struct Walk {
        RealMask walking;    // others have left their range or have crossed
        RealMask crossed;    // z lies behind a surface whose front is at front_z
        RealMask has_front;  // the last point was known and in front of a surface
        Real z, distance, advance;
        Real front_z, front;
    };

    // One step of every walking lane.
    [[gnu::always_inline]] void Advance(const Rays& rays, Walk& w) {
        const Cells cells = Locate(rays, w.z, w.walking);
        const Int steps = NearestDistance(cells);
        RealMask known = AsRealMask(steps != Int(-32768));
        Real distance = xsimd::to_float(steps) * Real(to_voxels_);
        // Stored distances run along the rays that measured them: too long for others, hence less than all of it.
        Real advance = Real(0.8f) * xsimd::abs(distance);
        const RealMask near = w.walking & known & (xsimd::abs(distance) <= Real(kNear));
        if (xsimd::any(near)) {
            RealMask all_known;
            const Real exact = Interpolate(cells, all_known);
            known = known & (all_known | ~near);
            distance = Select(near, exact, distance);
            // Half a voxel more than to the surface, so that the next step ends behind it.
            advance = Select(near, xsimd::abs(exact) + Real(0.5f), advance);
        }
        if (xsimd::any(w.walking & ~known)) advance = Select(known, advance, ThroughUnknown(rays, cells));
        const RealMask front = known & (distance > Real(0.0f));
        w.crossed = w.crossed | (w.walking & known & ~front & w.has_front);
        w.distance = Select(w.walking, distance, w.distance);
        w.advance = Select(w.walking, advance, w.advance);
        w.has_front = w.walking & front;
        w.front_z = Select(w.has_front, w.z, w.front_z);
        w.front = Select(w.has_front, distance, w.front);
        w.walking = w.walking & ~w.crossed;
        w.z = Select(w.walking, w.z + advance * rays.metres_per_voxel, w.z);
    }

    // The distance stored at the nearest voxel.
    [[gnu::always_inline]] Int NearestDistance(const Cells& cells) const {
        Int nearest[3];
        for (int k = 0; k < 3; ++k)
            nearest[k] = (cells.voxel[k] & Int(7)) + Select(cells.fraction[k] >= Real(0.5f), Int(1), Int(0));
        const Int slot = nearest[0] >> 3 | (nearest[1] >> 3) << 1 | (nearest[2] >> 3) << 2;
        Int owner = cells.block;
        if (xsimd::any(AsRealMask(slot != Int(0)))) owner = Gather(a_.neighbours, (owner << 3) + slot);
        const Int at = (owner << 9) + (nearest[0] & Int(7)) + ((nearest[1] & Int(7)) << 3) +
                       ((nearest[2] & Int(7)) << 6);
        return Gather(Words(a_.field), at) >> 16;
    }

    // The distance between the eight voxels, and where all are known.
    [[gnu::always_inline]] Real Interpolate(const Cells& cells, RealMask& known) const {
        Int index[8];
        CornerVoxels(a_, cells.block, cells.voxel, index);
        Real corner[8];
        Int lowest(0);
        for (int c = 0; c < 8; ++c) {
            const Int steps = Gather(Words(a_.field), index[c]) >> 16;
            lowest = xsimd::min(lowest, steps);
            corner[c] = xsimd::to_float(steps);
        }
        known = AsRealMask(lowest != Int(-32768));
        return Trilinear(corner, cells.fraction[0], cells.fraction[1], cells.fraction[2]).value * Real(to_voxels_);
    }

    // How far to walk where the distance is unknown: to the block's end if the map does not have it, else a voxel.
    [[gnu::always_inline]] static Real ThroughUnknown(const Rays& rays, const Cells& cells) {
        constexpr float kBeyond = 1e-2f;
        Real least(std::numeric_limits<float>::max());
        for (int k = 0; k < 3; ++k) {
            const Real into = xsimd::to_float(cells.voxel[k] & Int(7)) + cells.fraction[k];
            const Real end = Select(rays.step[k] >= Real(0.0f), Real(static_cast<float>(kBlockSide)), Real(0.0f));
            least = xsimd::min(least, (end - into) * rays.inverse_step[k]);
        }
        const Real to_end = xsimd::max(least / rays.metres_per_voxel, Real(0.0f)) + Real(kBeyond);
        return Select(AsRealMask(cells.block == Int(0)), to_end, Real(1.0f));
    }

    // The zeros between points in front and points behind, of the lanes that have crossed: regula falsi with the
    // Illinois rule. Not found where a distance is unknown and where the fall is over the whole range.
    [[gnu::always_inline]] Hits Refine(const Rays& rays, const Walk& w) {
        Real a_z = w.front_z, a = w.front, b_z = w.z, b = w.distance;
        RealMask pending = w.crossed & ~((a > Real(range_)) & (b < Real(-range_)));
        RealMask last_front(false), last_behind(false);
        Hits hits{RealMask(false), Real(0.0f)};
        for (int i = 0; i < kRefinements && xsimd::any(pending); ++i) {
            const Real z = Select(pending, a_z + (b_z - a_z) * a / (a - b), w.z);
            RealMask known;
            const Real distance = Interpolate(Locate(rays, z, pending), known);
            pending = pending & known;
            const RealMask exact = pending & (xsimd::abs(distance) < Real(kExact));
            hits.found = hits.found | exact;
            hits.depth_m = Select(exact, z, hits.depth_m);
            pending = pending & ~exact;
            const RealMask front = distance > Real(0.0f);
            b = Select(front & last_front, b * Real(0.5f), Select(front, b, distance));
            a = Select(~front & last_behind, a * Real(0.5f), Select(front, distance, a));
            a_z = Select(front, z, a_z);
            b_z = Select(front, b_z, z);
            last_front = front;
            last_behind = ~front;
        }
        return hits;
    }

    static const std::int32_t* Words(const std::uint32_t* words) { return reinterpret_cast<const std::int32_t*>(words); }

    const RayArguments& a_;
    const float to_voxels_;  // from distance steps
    const float range_;      // nearly the largest distance
    BlockCache cache_;
};

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
