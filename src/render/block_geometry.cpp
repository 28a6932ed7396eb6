#include "render/block_geometry.h"

namespace tessera {
namespace {

constexpr std::uint16_t kUnresolved = 0xffff, kMissing = 0xfffe;
constexpr int kEdgeMask = (1 << BlockMesh::kSlotShift) - 1;
constexpr std::size_t kRefs = std::size_t{8} << BlockMesh::kSlotShift;

GeometryVertex MakeVertex(const BlockMesh& owner, const BlockMesh::Vertex& vertex,
                          const BlockCoord& sector, const MarkVertex& mark) {
    const BlockCoord& block = owner.coord;
    const int offset = vertex.edge % kBlockVoxels, axis = vertex.edge / kBlockVoxels;
    const auto voxel = [](int b, int s, int in_block) {
        return static_cast<float>((b - s * kSectorBlocks) * kBlockSide + in_block);
    };
    GeometryVertex out{
        {voxel(block.x, sector.x, offset % 8), voxel(block.y, sector.y, offset / 8 % 8),
         voxel(block.z, sector.z, offset / 64)},
        vertex.normal,
        vertex.colour,
        static_cast<std::uint8_t>(vertex.has_colour ? 255 : 0),
        mark ? mark(owner, vertex) : VertexMark{}};
    out.position_voxels[static_cast<std::size_t>(axis)] +=
        static_cast<float>(vertex.fraction) / 65536;
    return out;
}

// Vertex index by VertexRef. All entries are kUnresolved between calls of Build, so that the cost
// of a call depends only on the block's vertices.
std::vector<std::uint16_t>& IndexTable() {
    thread_local std::vector<std::uint16_t> table(kRefs, kUnresolved);
    return table;
}

}  // namespace

void BlockGeometry::Build(const BlockMesh& mesh,
                          const std::vector<std::unique_ptr<const BlockMesh>>& meshes,
                          const MarkVertex& mark) {
    vertices.clear();
    indices.clear();
    const BlockCoord sector = SectorOf(mesh.coord);
    std::vector<std::uint16_t>& index_of = IndexTable();
    for (const BlockMesh::Vertex& vertex : mesh.vertices) {
        index_of[vertex.edge] = static_cast<std::uint16_t>(vertices.size());
        vertices.push_back(MakeVertex(mesh, vertex, sector, mark));
    }
    const auto resolve = [&](BlockMesh::VertexRef ref) {
        const auto id = static_cast<std::size_t>(mesh.blocks[ref >> BlockMesh::kSlotShift]);
        const BlockMesh* owner = id < meshes.size() ? meshes[id].get() : nullptr;
        const int found = owner ? owner->FindVertex(ref & kEdgeMask) : -1;
        if (found < 0) return kMissing;
        vertices.push_back(
            MakeVertex(*owner, owner->vertices[static_cast<std::size_t>(found)], sector, mark));
        return static_cast<std::uint16_t>(vertices.size() - 1);
    };
    for (const auto& triangle : mesh.triangles) {
        std::array<std::uint16_t, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            std::uint16_t& index = index_of[triangle[i]];
            if (index == kUnresolved) index = resolve(triangle[i]);
            corners[i] = index;
        }
        if (corners[0] != kMissing && corners[1] != kMissing && corners[2] != kMissing)
            indices.insert(indices.end(), corners.begin(), corners.end());
    }
    for (const BlockMesh::Vertex& vertex : mesh.vertices) index_of[vertex.edge] = kUnresolved;
    for (const auto& triangle : mesh.triangles)
        for (const BlockMesh::VertexRef ref : triangle) index_of[ref] = kUnresolved;
}

}  // namespace tessera
