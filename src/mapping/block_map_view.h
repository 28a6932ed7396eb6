// A block map as the kernels read it, in plain pointers, for the CPU's vector code and CUDA alike.
#pragma once

#include <cstdint>

#include "mapping/voxel.h"

namespace tessera {

struct BlockMapView {
    const FieldWord* field;  // [blocks * 512]
    // [blocks * 8]: at offsets (x, y, z) = bits 0, 1, 2 of the slot.
    const std::int32_t* neighbours;
    const std::int32_t* table;   // hash slots, each a BlockId, 0 = empty
    const std::int32_t* coords;  // [blocks * 4]: x, y, z, number
    std::uint32_t table_mask;
    float voxel_size_m, truncation_m;
};

}  // namespace tessera
