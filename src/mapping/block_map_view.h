// Plain-pointer view of a block map for the CPU's SIMD kernels and CUDA.
#pragma once

#include <cstdint>

#include "mapping/truncation_band.h"
#include "mapping/voxel.h"

namespace tessera {

struct BlockMapView {
    const FieldWord* field;  // [blocks * 512]
    // [blocks * 8]: the neighbour at offset (x, y, z) = bits 0, 1, 2 of the slot.
    const std::int32_t* neighbours;
    const std::int32_t* table;   // hash slots, each a BlockId, 0 = empty
    const std::int32_t* coords;  // [blocks * 4]: x, y, z, number
    std::uint32_t table_mask;
    float voxel_size_m;
    TruncationBand band;
};

}  // namespace tessera
