// Walking rays through the map, one per lane (scalar_lanes.h), to the first surface seen from the
// front. For the CPU's vectors and CUDA alike. How: far from the surface by steps of the stored
// distance, near it by the interpolated one; through unknown blocks to their end; a lane that has
// met a sign change waits until all have or have left the map, and then the zeros are refined
// together.
#pragma once

#include <cstdint>
#include <limits>

#include "mapping/block_kernels.h"
#include "mapping/ray_arguments.h"
#include "mapping/trilinear.h"

namespace tessera {

// Walks V::kCount rays at once, best neighbouring ones. Blocks finds the map's blocks: a
// HashedBlocks, or a BlockCache where one walker has many rays. All lengths are in voxels, depths
// along the camera's z apart, which are in metres.
template <class V, class Blocks>
class RayWalker {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;

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
        Mask found;
        Real depth_m;
    };

    TESSERA_HD_MEMBER explicit RayWalker(const RayArguments& a)
        : a_(a),
          to_voxels_(a.truncation_m / (kDistanceSteps * a.voxel_size_m)),
          range_(0.99f * a.truncation_m / a.voxel_size_m) {}

    // Of the `walking` lanes, between two depths.
    TESSERA_HD_MEMBER Hits FirstSurface(const Rays& rays, Mask walking, float first_m,
                                        float last_m) {
        Hits hits{Mask(false), Real(0.0f)};
        Walk w{walking,    Mask(false), Mask(false), Real(first_m),
               Real(0.0f), Real(0.0f),  Real(0.0f),  Real(0.0f)};
        const Real last(last_m);
        for (;;) {
            w.walking = w.walking && (w.z <= last);
            // A lane that has crossed waits for the others: refined together they cost as much as
            // one.
            while (V::Any(w.walking)) {
                Advance(rays, w);
                w.walking = w.walking && (w.z <= last);
            }
            if (!V::Any(w.crossed)) return hits;
            const Hits refined = Refine(rays, w);
            hits.found = hits.found || refined.found;
            hits.depth_m = V::Select(refined.found, refined.depth_m, hits.depth_m);
            w.walking = w.crossed && V::Not(refined.found);
            w.z = V::Select(w.walking, w.z + w.advance * rays.metres_per_voxel, w.z);
            w.crossed = Mask(false);
        }
    }

    // The cells at depth z; blocks only of the wanted lanes.
    TESSERA_HD_MEMBER Cells Locate(const Rays& rays, const Real& z, const Mask& wanted) {
        Cells cells;
        Int block[3];
        for (int k = 0; k < 3; ++k) {
            const Real p = Real(a_.start[k]) + z * rays.step[k];
            const Real lower = V::Floor(p);
            cells.voxel[k] = V::ToInt(lower);
            cells.fraction[k] = p - lower;
            block[k] = cells.voxel[k] >> 3;
        }
        cells.block = blocks_.Find(a_, block, wanted);
        return cells;
    }

  private:
    // Interpolated from here on; farther off the nearest voxel will do.
    static constexpr float kNear = 1.5f;
    static constexpr float kExact = 1e-3f;  // what is that near to zero is the surface
    static constexpr int kRefinements = 12;

    // Where each lane has come to.
    struct Walk {
        Mask walking;    // others have left their range or have crossed
        Mask crossed;    // z lies behind a surface whose front is at front_z
        Mask has_front;  // the last point was known and in front of a surface
        Real z, distance, advance;
        Real front_z, front;
    };

    // One step of every walking lane.
    TESSERA_HD_MEMBER void Advance(const Rays& rays, Walk& w) {
        const Cells cells = Locate(rays, w.z, w.walking);
        const Int steps = NearestDistance(cells);
        Mask known = V::ToMask(steps != Int(-32768));
        Real distance = V::ToReal(steps) * Real(to_voxels_);
        // Stored distances run along the rays that measured them: too long for others, hence less
        // than all of it.
        Real advance = Real(0.8f) * V::Abs(distance);
        const Mask near = w.walking && known && (V::Abs(distance) <= Real(kNear));
        if (V::Any(near)) {
            Mask all_known;
            const Real exact = Interpolate(cells, all_known);
            known = known && (all_known || V::Not(near));
            distance = V::Select(near, exact, distance);
            // Half a voxel more than to the surface, so that the next step ends behind it.
            advance = V::Select(near, V::Abs(exact) + Real(0.5f), advance);
        }
        if (V::Any(w.walking && V::Not(known)))
            advance = V::Select(known, advance, ThroughUnknown(rays, cells));
        const Mask front = known && (distance > Real(0.0f));
        w.crossed = w.crossed || (w.walking && known && V::Not(front) && w.has_front);
        w.distance = V::Select(w.walking, distance, w.distance);
        w.advance = V::Select(w.walking, advance, w.advance);
        w.has_front = w.walking && front;
        w.front_z = V::Select(w.has_front, w.z, w.front_z);
        w.front = V::Select(w.has_front, distance, w.front);
        w.walking = w.walking && V::Not(w.crossed);
        w.z = V::Select(w.walking, w.z + advance * rays.metres_per_voxel, w.z);
    }

    // The distance stored at the nearest voxel.
    TESSERA_HD_MEMBER Int NearestDistance(const Cells& cells) const {
        Int nearest[3];
        for (int k = 0; k < 3; ++k)
            nearest[k] = (cells.voxel[k] & Int(7)) +
                         V::Select(cells.fraction[k] >= Real(0.5f), Int(1), Int(0));
        const Int slot = nearest[0] >> 3 | (nearest[1] >> 3) << 1 | (nearest[2] >> 3) << 2;
        Int owner = cells.block;
        if (V::Any(V::ToMask(slot != Int(0))))
            owner = V::Gather(a_.neighbours, (owner << 3) + slot);
        const Int at = (owner << 9) + (nearest[0] & Int(7)) + ((nearest[1] & Int(7)) << 3) +
                       ((nearest[2] & Int(7)) << 6);
        return V::AsInt(V::Gather(a_.field, at)) >> 16;
    }

    // The distance between the eight voxels, and where all are known.
    TESSERA_HD_MEMBER Real Interpolate(const Cells& cells, Mask& known) const {
        Int index[8];
        BlockKernels<V>::CornerVoxels(a_, cells.block, cells.voxel, index);
        Real corner[8];
        Int lowest(0);
        for (int c = 0; c < 8; ++c) {
            const Int steps = V::AsInt(V::Gather(a_.field, index[c])) >> 16;
            lowest = V::Min(lowest, steps);
            corner[c] = V::ToReal(steps);
        }
        known = V::ToMask(lowest != Int(-32768));
        return Trilinear(corner, cells.fraction[0], cells.fraction[1], cells.fraction[2]).value *
               Real(to_voxels_);
    }

    // How far to walk where the distance is unknown: to the block's end if the map does not have
    // it, else a voxel.
    TESSERA_HD_MEMBER static Real ThroughUnknown(const Rays& rays, const Cells& cells) {
        constexpr float kBeyond = 1e-2f;
        Real least(std::numeric_limits<float>::max());
        for (int k = 0; k < 3; ++k) {
            const Real into = V::ToReal(cells.voxel[k] & Int(7)) + cells.fraction[k];
            const Real end = V::Select(rays.step[k] >= Real(0.0f),
                                       Real(static_cast<float>(kBlockSide)), Real(0.0f));
            least = V::Min(least, (end - into) * rays.inverse_step[k]);
        }
        const Real to_end = V::Max(least / rays.metres_per_voxel, Real(0.0f)) + Real(kBeyond);
        return V::Select(V::ToMask(cells.block == Int(0)), to_end, Real(1.0f));
    }

    // The zeros between points in front and points behind, of the lanes that have crossed: regula
    // falsi with the Illinois rule. Not found where a distance is unknown and where the fall is
    // over the whole range.
    TESSERA_HD_MEMBER Hits Refine(const Rays& rays, const Walk& w) {
        Real a_z = w.front_z, a = w.front, b_z = w.z, b = w.distance;
        Mask pending = w.crossed && V::Not((a > Real(range_)) && (b < Real(-range_)));
        Mask last_front(false), last_behind(false);
        Hits hits{Mask(false), Real(0.0f)};
        for (int i = 0; i < kRefinements && V::Any(pending); ++i) {
            const Real z = V::Select(pending, a_z + (b_z - a_z) * a / (a - b), w.z);
            Mask known;
            const Real distance = Interpolate(Locate(rays, z, pending), known);
            pending = pending && known;
            const Mask exact = pending && (V::Abs(distance) < Real(kExact));
            hits.found = hits.found || exact;
            hits.depth_m = V::Select(exact, z, hits.depth_m);
            pending = pending && V::Not(exact);
            const Mask front = distance > Real(0.0f);
            b = V::Select(front && last_front, b * Real(0.5f), V::Select(front, b, distance));
            a = V::Select(V::Not(front) && last_behind, a * Real(0.5f),
                          V::Select(front, distance, a));
            a_z = V::Select(front, z, a_z);
            b_z = V::Select(front, b_z, z);
            last_front = front;
            last_behind = V::Not(front);
        }
        return hits;
    }

    const RayArguments& a_;
    const float to_voxels_;  // from distance steps
    const float range_;      // nearly the largest distance
    Blocks blocks_;
};

}  // namespace tessera
