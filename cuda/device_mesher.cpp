#include "cuda/device_mesher.h"

#include <algorithm>

namespace tessera::TESSERA_DEVICE {
namespace {

// The mesh of block `i` of `arrays`.
std::unique_ptr<const BlockMesh> TakeMesh(const SurfaceArrays& arrays, std::size_t i,
                                          const BlockMap& map, BlockId id) {
    const auto [vertex, triangle] = arrays.first[i];
    const auto [vertex_end, triangle_end] = arrays.first[i + 1];
    if (vertex == vertex_end && triangle == triangle_end) return nullptr;
    auto mesh = std::make_unique<BlockMesh>();
    mesh->coord = map.coord(id);
    std::copy_n(map.view().neighbours + 8 * static_cast<std::size_t>(id), 8, mesh->blocks.begin());
    mesh->vertices.assign(arrays.vertices.begin() + vertex, arrays.vertices.begin() + vertex_end);
    mesh->triangles.assign(arrays.triangles.begin() + triangle,
                           arrays.triangles.begin() + triangle_end);
    return mesh;
}

}  // namespace

DeviceMesher::DeviceMesher(DevicePipeline& device) : device_(device) {}

bool DeviceMesher::MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                              double min_weight, BlockMeshes& meshes) {
    if (blocks.empty()) return true;
    DeviceMap* mirror = device_.MirrorOf(map);
    if (mirror == nullptr) return false;
    constexpr std::size_t kLeastBlocks = 32;  // at once: fewer are not worth it
    std::size_t most = DeviceSurface::kMaxBlocks;
    while (!blocks.empty()) {
        const std::span<const BlockId> part = blocks.first(std::min(most, blocks.size()));
        if (!surface_) surface_.emplace(device_.memory_, device_.stream_);
        if (!surface_->Extract(mirror->view(), part.data(), static_cast<int>(part.size()),
                               MakeCellLimits(min_weight, map.config()), arrays_)) {
            surface_.reset();  // its buffers leave less room for a smaller batch
            most = std::min(most, part.size()) / 2;
            if (most < kLeastBlocks) return false;
            continue;
        }
        for (std::size_t i = 0; i < part.size(); ++i)
            meshes[static_cast<std::size_t>(part[i])] = TakeMesh(arrays_, i, map, part[i]);
        blocks = blocks.subspan(part.size());
    }
    return true;
}

}  // namespace tessera::TESSERA_DEVICE
