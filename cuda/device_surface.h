// Marching cubes over blocks of the device's map, with the formulas of mapping/cell_kernels.h and
// mesh_kernels.h.
#pragma once

#include <array>
#include <vector>

#include "cuda/device_map.h"
#include "mapping/mesh_kernels.h"

namespace tessera::TESSERA_DEVICE {

// What BlockMesh holds of each of some blocks, one after the other, in the computer's memory.
struct SurfaceArrays {
    struct First {
        std::int32_t vertex, triangle;
    };
    std::vector<First> first;  // of each block, and one more: the ends
    std::vector<MeshVertex> vertices;
    std::vector<std::array<MeshVertexRef, 3>> triangles;
};

// Counts what each row of cells makes, sums the counts up, and writes everything to its place:
// nothing depends on which thread was first. Owner thread only; `memory` and `stream` outlive it.
class DeviceSurface {
  public:
    DeviceSurface(DeviceMemory& memory, Stream& stream);

    static constexpr int kMaxBlocks = 512;  // at once: with what they make 5 to 10 MB

    // The surface of at most kMaxBlocks blocks, none of them the unknown one; `ids` is in the
    // computer's memory. False: no room on the device.
    [[nodiscard]] bool Extract(const DeviceMapView& map, const std::int32_t* ids, int count,
                               int min_weight_steps, SurfaceArrays& out);

  private:
    [[nodiscard]] bool Reserve(std::size_t blocks);
    [[nodiscard]] bool Count(const DeviceMapView& map, int count, int min_weight_steps);

    Stream& stream_;
    DeviceSorter sums_;
    DeviceBuffer<CubeCase> cases_;
    DeviceBuffer<std::int32_t> ids_, reads_;
    DeviceBuffer<RowBits> rows_;
    DeviceBuffer<FieldWord> aprons_;
    // By row of cells: how many, and how many before.
    DeviceBuffer<std::int32_t> vertex_count_, triangle_count_, vertex_first_, triangle_first_;
    DeviceBuffer<SurfaceArrays::First> first_;
    DeviceBuffer<MeshVertex> vertices_;
    DeviceBuffer<std::array<MeshVertexRef, 3>> triangles_;
};

}  // namespace tessera::TESSERA_DEVICE
