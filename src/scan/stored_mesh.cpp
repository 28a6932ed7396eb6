#include "scan/stored_mesh.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <unordered_map>

#include "mapping/mesh_assembly.h"
#include "scan/cube_reader.h"
#include "scan/scan_file.h"

namespace tessera {
namespace {

// A map that holds the cubes around the one being meshed.
class CubeWindow {
  public:
    CubeWindow(CubeReader& reader, const BlockMap::Config& config, bool labels)
        : reader_(reader), map_(config) {
        if (labels) map_.EnableLabels();
    }

    const BlockMap& map() const { return map_; }

    Status Index() {
        Result<std::vector<std::pair<std::int64_t, std::int32_t>>> cubes = reader_.Cubes();
        if (!cubes.ok()) return cubes.status();
        for (const auto& [key, blocks] : cubes.value()) {
            order_.push_back(key);
            cubes_[key].stored = blocks;
            count_ += blocks;
        }
        return Status::Ok();
    }
    // The number of blocks in all cubes. Block numbers run from 1 to this.
    std::int64_t count() const { return count_; }
    const std::vector<std::int64_t>& order() const { return order_; }
    const std::vector<BlockId>& blocks(std::int64_t key) const { return cubes_.at(key).ids; }

    // Loads the cube and all its neighbours.
    Status MoveTo(std::int64_t key) {
        // 100 MB. Released cubes are re-read at most a few times.
        constexpr std::int64_t kMostBlocks = 20000;
        const BlockCoord at = CubeOfKey(key);
        if (map_.count() > kMostBlocks) Leave(at);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const auto cube = cubes_.find(CubeKey({at.x + x, at.y + y, at.z + z}));
                    if (cube == cubes_.end() || !cube->second.ids.empty()) continue;
                    if (Status status = Load(cube->first, cube->second); !status.ok())
                        return status;
                }
        return Status::Ok();
    }

  private:
    struct Cube {
        std::int32_t stored = 0;
        std::vector<BlockId> ids;  // empty: not in the map
    };

    Status Load(std::int64_t key, Cube& cube) {
        if (Status status = reader_.Read(key, copies_); !status.ok()) return status;
        if (static_cast<std::int32_t>(copies_.size()) != cube.stored)
            return DamagedScan(reader_.path(), "blocks");
        for (std::size_t i = 0; i < copies_.size(); ++i) {
            const BlockId id = map_.Allocate(copies_.coords[i], copies_.numbers[i]);
            copies_.Put(i, map_, id);
            cube.ids.push_back(id);
        }
        return Status::Ok();
    }

    void Leave(const BlockCoord& at) {
        for (auto& [key, cube] : cubes_) {
            const BlockCoord c = CubeOfKey(key);
            if (std::max({std::abs(c.x - at.x), std::abs(c.y - at.y), std::abs(c.z - at.z)}) <= 1)
                continue;
            for (const BlockId id : cube.ids) map_.Release(id);
            cube.ids.clear();
        }
    }

    CubeReader& reader_;
    BlockMap map_;
    std::unordered_map<std::int64_t, Cube> cubes_;
    std::vector<std::int64_t> order_;
    std::int64_t count_ = 0;
    BlockCopies copies_;
};

// Indexed by block number.
struct CubeMeshes {
    std::vector<std::unique_ptr<const BlockMesh>> meshes;
    BlockVertexLabels labels;
};

// Meshes one block and replaces the block ids in its mesh by block numbers.
void MeshByNumber(const BlockMap& map, BlockId id, double min_weight,
                  const StoredVertexLabel& label, CubeMeshes& out) {
    const std::unique_ptr<const BlockMesh> mesh = MeshBlock(map, id, min_weight);
    if (!mesh) return;
    const auto number = static_cast<std::size_t>(map.number(id));
    if (label) {
        std::vector<VertexLabel> labels;
        for (const BlockMesh::Vertex& vertex : mesh->vertices)
            labels.push_back(label(map, *mesh, vertex));
        if (std::ranges::any_of(labels, [](const VertexLabel& l) { return l != VertexLabel{}; }))
            out.labels[number] = std::move(labels);
    }
    auto numbered = std::make_unique<BlockMesh>(*mesh);
    for (BlockId& block : numbered->blocks) block = map.number(block);
    out.meshes[number] = std::move(numbered);
}

Result<CubeMeshes> MeshCubes(const std::string& path, const BlockMap::Config& config,
                             double min_weight, const StoredVertexLabel& label) {
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(path);
    if (!reader.ok()) return reader.status();
    CubeWindow window(*reader.value(), config, static_cast<bool>(label));
    if (Status status = window.Index(); !status.ok()) return status;
    CubeMeshes all;
    all.meshes.resize(static_cast<std::size_t>(window.count()) + 1);
    if (label) all.labels.resize(all.meshes.size());
    std::vector<bool> there(all.meshes.size());
    for (const std::int64_t key : window.order()) {
        if (Status status = window.MoveTo(key); !status.ok()) return status;
        const std::vector<BlockId>& blocks = window.blocks(key);
        for (const BlockId id : blocks) {
            const auto number = static_cast<std::size_t>(window.map().number(id));
            if (number >= there.size() || there[number])
                return DamagedScan(path, fmt::format("block number {}", number));
            there[number] = true;
        }
        tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
            MeshByNumber(window.map(), blocks[i], min_weight, label, all);
        });
    }
    return all;
}

}  // namespace

Result<TriangleMesh> MeshOfStoredMap(const std::string& path, const BlockMap::Config& config,
                                     const MeshConfig& meshing, const StoredVertexLabel& label) {
    const Result<CubeMeshes> cubes = MeshCubes(path, config, meshing.min_weight, label);
    if (!cubes.ok()) return cubes.status();
    return AssembleMesh(cubes.value().meshes, config.voxel_size_m, meshing.min_component_triangles,
                        cubes.value().labels);
}

}  // namespace tessera
