// Marching cubes over blocks of the device's map, with the formulas of mapping/cell_kernels.h and
// mesh_kernels.h.
#pragma once

#include <array>
#include <vector>

#include "cuda/device_map.h"
#include "mapping/mesh_kernels.h"

namespace tessera::TESSERA_DEVICE {

// The contents of several BlockMeshes, one after the other, in host memory.
struct SurfaceArrays {
    struct First {
        std::int32_t vertex, triangle;
    };
    std::vector<First> first;  // of each block, plus one entry for the ends
    std::vector<MeshVertex> vertices;
    std::vector<std::array<MeshVertexRef, 3>> triangles;
};

// Counts the output of each row of cells, takes prefix sums of the counts, and writes everything to
// its place. So the result does not depend on the order of threads. Owner thread only; `memory` and
// `stream` must outlive it.
class DeviceSurface {
  public:
    DeviceSurface(DeviceMemory& memory, Stream& stream);

    static constexpr int kMaxBlocks = 512;  // at once; 5 to 10 MB with their output

    // Extracts the surface of at most kMaxBlocks blocks, none of them the unknown one. `ids` is in
    // host memory. Returns false if the device has no room.
    [[nodiscard]] bool Extract(const DeviceMapView& map, const std::int32_t* ids, int count,
                               const CellLimits& limits, SurfaceArrays& out);

  private:
    [[nodiscard]] bool Reserve(std::size_t blocks);
    [[nodiscard]] bool Count(const DeviceMapView& map, int count, const CellLimits& limits);

    Stream& stream_;
    DeviceSorter sums_;
    DeviceBuffer<CubeCase> cases_;
    DeviceBuffer<std::int32_t> ids_, reads_;
    DeviceBuffer<RowBits> rows_;
    DeviceBuffer<FieldWord> aprons_;
    // Per row of cells: its count, and the sum of the counts before it.
    DeviceBuffer<std::int32_t> vertex_count_, triangle_count_, vertex_first_, triangle_first_;
    DeviceBuffer<SurfaceArrays::First> first_;
    DeviceBuffer<MeshVertex> vertices_;
    DeviceBuffer<std::array<MeshVertexRef, 3>> triangles_;
};

}  // namespace tessera::TESSERA_DEVICE
