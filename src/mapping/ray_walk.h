// Walks rays through the map, one per lane (scalar_lanes.h), to the first front-facing surface.
// Shared by the CPU's SIMD kernels and CUDA. Far from the surface a ray steps by the stored
// distance, near it by the interpolated one. It crosses an unknown block in one step. A lane that
// meets a sign change waits until every other lane has met one or left the map. Then the zeros are
// refined together.
#pragma once

#include <cstdint>
#include <limits>

#include "mapping/block_kernels.h"
#include "mapping/ray_arguments.h"
#include "mapping/trilinear.h"

namespace tessera {

// Walks V::kCount rays at once, preferably neighbouring ones. `Blocks` finds the map's blocks: a
// HashedBlocks, or a BlockCache where one walker casts many rays. All lengths are in voxels, except
// depths along the camera's z, which are in metres.
template <class V, class Blocks>
class RayWalker {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // One ray per lane, parametrised by depth z: p(z) = start + z * step.
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
          to_voxels_(a.band.most_m / (kDistanceSteps * a.voxel_size_m)),
          jump_(0.99f * a.band.least_m / a.voxel_size_m) {}

    // The first surface of each `walking` lane between two depths.
    TESSERA_HD_MEMBER Hits FirstSurface(const Rays& rays, Mask walking, float first_m,
                                        float last_m) {
        Hits hits{Mask(false), Real(0.0f)};
        Walk w{walking,    Mask(false), Mask(false), Real(first_m),
               Real(0.0f), Real(0.0f),  Real(0.0f),  Real(0.0f)};
        const Real last(last_m);
        for (;;) {
            w.walking = w.walking && (w.z <= last);
            // A lane that has crossed waits for the others: refining all lanes costs as much as
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

    // The cells at depth z. Looks up blocks only for the wanted lanes.
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
    // Interpolate within this distance; farther away the nearest voxel suffices.
    static constexpr float kNear = 1.5f;
    static constexpr float kExact = 1e-3f;  // a smaller distance counts as zero
    static constexpr int kRefinements = 12;

    // The progress of each lane.
    struct Walk {
        Mask walking;    // the other lanes have left their range or have crossed
        Mask crossed;    // z lies behind a surface whose front is at front_z
        Mask has_front;  // the last point was known and in front of a surface
        Real z, distance, advance;
        Real front_z, front;
    };

    // Advances every walking lane by one step.
    TESSERA_HD_MEMBER void Advance(const Rays& rays, Walk& w) {
        const Cells cells = Locate(rays, w.z, w.walking);
        const Int steps = NearestDistance(cells);
        Mask known = V::ToMask(steps != Int(-32768));
        Real distance = V::ToReal(steps) * Real(to_voxels_);
        // Stored distances run along the rays that measured them. They can be too long for other
        // rays, so step by less.
        Real advance = Real(0.8f) * V::Abs(distance);
        const Mask near = w.walking && known && (V::Abs(distance) <= Real(kNear));
        if (V::Any(near)) {
            Mask all_known;
            const Real exact = Interpolate(cells, all_known);
            known = known && (all_known || V::Not(near));
            distance = V::Select(near, exact, distance);
            // Go half a voxel beyond the surface, so that the next step ends behind it.
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

    // The trilinear distance. `known`: all eight voxels are known.
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

    // The step through an unknown distance: to the block's end if the map lacks the block, else one
    // voxel.
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

    // Refines the zeros between the front and back points of crossed lanes, by regula falsi with
    // the Illinois rule. A lane finds nothing if a distance is unknown or the drop spans a whole
    // band: from free space to behind another surface.
    TESSERA_HD_MEMBER Hits Refine(const Rays& rays, const Walk& w) {
        Real a_z = w.front_z, a = w.front, b_z = w.z, b = w.distance;
        Mask pending = w.crossed && V::Not((a > Real(jump_)) && (b < Real(-jump_)));
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
    const float to_voxels_;  // converts distance steps
    const float jump_;       // nearly the narrowest band
    Blocks blocks_;
};

}  // namespace tessera
