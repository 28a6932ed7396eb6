// Reads the map for lanes of points (scalar_lanes.h): finds each point's block and the indices of
// the eight voxels around it. Shared by the CPU's SIMD kernels and CUDA. `Map` is BlockMapView or
// any struct with the same plain pointers.
#pragma once

#include "mapping/voxel.h"

namespace tessera {

template <class V>
struct BlockKernels {
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // BlockMap::Find for every pending lane; the other lanes get kUnknownBlock. x, y, z: world
    // coordinates of the block.
    template <class Map>
    TESSERA_HD_MEMBER static Int FindBlocks(const Map& map, const Int& x, const Int& y,
                                            const Int& z, Mask pending) {
        const Int mask(static_cast<std::int32_t>(map.table_mask));
        Int slot = V::AsInt(HashBits(V::AsBits(x), V::AsBits(y), V::AsBits(z))) & mask;
        Int found(0);
        while (V::Any(pending)) {
            const Int id = V::Gather(map.table, slot);
            const Int at = id << 2;
            const Mask match = V::ToMask((V::Gather(map.coords, at) == x) &&
                                         (V::Gather(map.coords + 1, at) == y) &&
                                         (V::Gather(map.coords + 2, at) == z));
            found = V::Select(pending && match, id, found);
            pending = pending && V::Not(match) && V::ToMask(id != Int(0));
            slot = (slot + Int(1)) & mask;
        }
        return found;
    }

    // Layer indices of the cells' corners: index[c] is the corner at offset (x, y, z) = bits 0, 1,
    // 2 of c. `voxel` is the lowest corner. Only its three low bits count, because it lies in
    // `block`.
    template <class Map>
    TESSERA_HD_MEMBER static void CornerVoxels(const Map& map, const Int& block, const Int* voxel,
                                               Int* index) {
        const Int seven(7);
        const Int x0 = voxel[0] & seven, y0 = voxel[1] & seven, z0 = voxel[2] & seven;
        const Int x1 = x0 + Int(1), y1 = y0 + Int(1), z1 = z0 + Int(1);
        // The neighbour's slot bit where the upper corner leaves the block, else 0.
        const Int over_x = x1 >> 3, over_y = y1 >> 3, over_z = z1 >> 3;
        const Int in_x[2] = {x0, x1 & seven};
        const Int in_y[2] = {y0 << 3, (y1 & seven) << 3};
        const Int in_z[2] = {z0 << 6, (z1 & seven) << 6};
        const bool inside = !V::Any(V::ToMask((over_x | over_y | over_z) != Int(0)));
        for (int c = 0; c < 8; ++c) {
            const int bx = c & 1, by = c >> 1 & 1, bz = c >> 2;
            Int owner = block;
            if (!inside && c != 0) {
                const Int slot = (bx ? over_x : Int(0)) | (by ? over_y << 1 : Int(0)) |
                                 (bz ? over_z << 2 : Int(0));
                owner = V::Gather(map.neighbours, (block << 3) + slot);
            }
            index[c] = (owner << 9) + in_x[bx] + in_y[by] + in_z[bz];
        }
    }
};

// Finds blocks for rays through the map's hash, without a cache. BlockCache uses it on a miss.
template <class V>
struct HashedBlocks {
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // See BlockCache::Find.
    template <class Map>
    TESSERA_HD_MEMBER Int Find(const Map& map, const Int* block, const Mask& wanted) const {
        const std::int32_t* origin = map.origin_block;
        return BlockKernels<V>::FindBlocks(map, block[0] + Int(origin[0]),
                                           block[1] + Int(origin[1]), block[2] + Int(origin[2]),
                                           wanted);
    }
};

}  // namespace tessera
