#include "cuda/device_mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cuda/desk_frames.h"
#include "cuda/same_mesh.h"
#include "mapping/analytic_fields.h"
#include "mapping/mesh_measures.h"
#include "system/pipeline.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;
using testing_support::ExpectMeshesOf;
using testing_support::kPlenty;
using testing_support::MeshOf;
using testing_support::Mix;
using testing_support::PackColour;
using testing_support::PackField;
using testing_support::SameBytes;
using testing_support::Uniform;

std::vector<BlockId> AllBlocks(const BlockMap& map) {
    std::vector<BlockId> ids(static_cast<std::size_t>(map.size() - 1));
    std::iota(ids.begin(), ids.end(), 1);
    return ids;
}

// A cube of `side` blocks per edge, starting at `low`, with random voxels: some are unknown, have
// too little weight, lie at the end of the range, or have no intensity.
std::unique_ptr<const BlockMap> Noise(const BlockCoord& low, int side) {
    auto noise = std::make_unique<BlockMap>(BlockMap::Config{});
    BlockMap& map = *noise;
    std::uint32_t counter = 0;
    const auto random = [&](unsigned n) { return static_cast<int>(Mix(++counter) % n); };
    for (int i = 0; i < side * side * side; ++i) {
        const BlockId id =
            map.Allocate({low.x + i % side, low.y + i / side % side, low.z + i / side / side});
        for (int v = 0; v < kBlockVoxels; ++v) {
            const double distance = random(20)  ? 0.9 * (2 * Uniform(++counter) - 1)
                                    : random(2) ? 1.0
                                                : -1.0;
            const double intensity = random(4) ? Uniform(++counter) : -1;
            map.field(id)[v] = random(30) ? PackField(distance, intensity) : kUnknownField;
            map.weight(id)[v] = static_cast<std::uint16_t>(random(30) ? 512 : 100);
            map.colour(id)[v] = PackColour({Uniform(counter), Uniform(counter + 1), 0.3});
        }
    }
    return noise;
}

void ExpectDeviceMeshes(const BlockMap& map, const std::vector<BlockId>& blocks, double min_weight,
                        std::size_t least_triangles) {
    DevicePipeline device("host", kPlenty);
    const std::unique_ptr<BlockMesher> mesher = device.MakeBlockMesher();
    BlockMeshes meshes(static_cast<std::size_t>(map.size()));
    ASSERT_TRUE(mesher->MeshBlocks(map, blocks, min_weight, meshes));
    EXPECT_GE(ExpectMeshesOf(map, blocks, min_weight, meshes), least_triangles);
}

TEST(DeviceMesher, MakesTheBytesOfAFusedMapsMeshes) {
    BlockMap map{BlockMap::Config()};
    Integrator integrator({}, DeskCamera());
    for (const DeskFrame& frame : DeskFrames()) {
        Integrator::View view;
        view.T_world_camera = frame.T_world_camera;
        integrator.Integrate(frame.prepared, view, map);
    }
    ASSERT_GT(map.size(), 2 * DeviceSurface::kMaxBlocks);  // several batches
    for (const double min_weight : {0.0, 2.5})
        ExpectDeviceMeshes(map, AllBlocks(map), min_weight, 5000);
}

// Covers every configuration, within blocks and across their borders, next to unknown voxels and
// where the weight is too low. The blocks may come in any order.
TEST(DeviceMesher, MakesTheBytesOfNoise) {
    const std::unique_ptr<const BlockMap> noise = Noise({-2, -3, -1}, 4);
    const BlockMap& map = *noise;
    for (const double min_weight : {0.0, 1.0})
        ExpectDeviceMeshes(map, AllBlocks(map), min_weight, 10000);
    std::vector<BlockId> some = AllBlocks(map);
    std::erase_if(some, [](BlockId id) { return id % 3 == 0; });
    std::ranges::reverse(some);
    ExpectDeviceMeshes(map, some, 1.0, 5000);
    ExpectDeviceMeshes(map, {17}, 1.0, 100);
}

TEST(DeviceMesher, MakesTheBytesAtTheEndsOfTheWorld) {
    for (const std::int32_t low : {-kBlockLimit, kBlockLimit - 2}) {
        const std::unique_ptr<const BlockMap> map = Noise({low, low, low}, 2);
        ASSERT_EQ(map->size(), 9);
        ExpectDeviceMeshes(*map, AllBlocks(*map), 0, 1000);
    }
}

TEST(DeviceMesher, AnEmptyMapIsAnEmptyMesh) {
    DevicePipeline device("host", kPlenty);
    const std::unique_ptr<BlockMesher> mesher = device.MakeBlockMesher();
    const BlockMap map{BlockMap::Config()};
    BlockMeshes meshes(1);
    EXPECT_TRUE(mesher->MeshBlocks(map, {}, 0, meshes));
    Mesher of_map({});
    EXPECT_EQ(of_map.Update(map, Mesher::kNoLimit, *mesher), 0);
    EXPECT_TRUE(of_map.Assemble().vertices.empty());
    MappingStage stage({}, {}, DeskCamera(), &device);
    EXPECT_TRUE(stage.TakeMesh().vertices.empty());
    EXPECT_EQ(stage.mesh_warning(), "");
}

// A block that no longer has a surface loses its mesh.
TEST(DeviceMesher, TakesTheMeshAwayWhereThereIsNoSurface) {
    const std::unique_ptr<const BlockMap> map = Noise({0, 0, 0}, 1);
    DevicePipeline device("host", kPlenty);
    const std::unique_ptr<BlockMesher> mesher = device.MakeBlockMesher();
    BlockMeshes meshes(2);
    meshes[1] = std::make_unique<BlockMesh>();
    const BlockId id = 1;
    ASSERT_TRUE(mesher->MeshBlocks(*map, {&id, 1}, 200, meshes));  // above every weight
    EXPECT_EQ(meshes[1], nullptr);
}

TEST(DeviceMesher, TakesFewerBlocksAtOnceWhereMemoryIsShortAndRefusesWhereThereIsNone) {
    const std::unique_ptr<const BlockMap> noise = Noise({0, 0, 0}, 10);
    const BlockMap& map = *noise;
    const std::vector<BlockId> blocks = AllBlocks(map);
    DevicePipeline probe("host", kPlenty);
    const std::unique_ptr<BlockMesher> probing = probe.MakeBlockMesher();
    BlockMeshes meshes(static_cast<std::size_t>(map.size()));
    ASSERT_TRUE(probing->MeshBlocks(map, {blocks.data(), 1}, 0, meshes));
    const std::size_t of_map = probe.used_bytes();
    ASSERT_TRUE(probing->MeshBlocks(map, blocks, 0, meshes));
    const std::size_t of_meshing = probe.used_bytes() - of_map;
    EXPECT_GT(of_meshing, std::size_t{10} << 20);

    DevicePipeline shorter("host", of_map + of_meshing / 4);
    meshes = BlockMeshes(meshes.size());
    ASSERT_TRUE(shorter.MakeBlockMesher()->MeshBlocks(map, blocks, 0, meshes));
    ExpectMeshesOf(map, blocks, 0, meshes);

    DevicePipeline full("host", of_map + (std::size_t{64} << 10)),
        tiny("host", std::size_t{1} << 20);
    for (DevicePipeline* device : {&full, &tiny}) {
        const std::unique_ptr<BlockMesher> mesher = device->MakeBlockMesher();
        EXPECT_FALSE(mesher->MeshBlocks(map, blocks, 0, meshes));
        Mesher refused({});
        EXPECT_EQ(refused.Update(map, Mesher::kNoLimit, *mesher), map.size() - 1);
        EXPECT_TRUE(refused.updated().empty());
        EXPECT_EQ(refused.Update(map), 0);  // all blocks were still pending
        EXPECT_TRUE(
            SameBytes(refused.Assemble(), MeshOf(map, refused.config().min_component_triangles)));
    }
}

TriangleMesh MeshHere(const BlockMap& map) {
    return MeshOf(map, MeshConfig().min_component_triangles);
}

// Meshes what the device fused. The voxels are not copied to the host.
TEST(MappingStage, MeshesOnTheDeviceWithoutItsVoxels) {
    DevicePipeline device("host", kPlenty);
    Pipeline pipeline({}, DeskCamera(), {}, &device);
    Mesher as_it_goes({});
    const std::unique_ptr<BlockMesher> mesher = device.MakeBlockMesher();
    for (const DeskFrame& frame : DeskFrames()) {
        pipeline.Process(frame.frame);
        as_it_goes.Update(pipeline.mapping().blocks(), Mesher::kNoLimit, *mesher);
    }
    MappingStage& mapping = pipeline.mapping();
    const TriangleMesh mesh = mapping.Mesh();
    EXPECT_GT(mesh.triangles.size(), 5000u);
    const BlockMap& blocks = mapping.blocks();
    for (BlockId id = 1; id < blocks.size(); ++id)
        ASSERT_TRUE(std::all_of(blocks.field(id), blocks.field(id) + kBlockVoxels,
                                [](FieldWord w) { return w == kUnknownField; }));
    const TriangleMesh expected = MeshHere(mapping.map());  // copies the voxels to the host
    EXPECT_TRUE(SameBytes(mesh, expected));
    EXPECT_TRUE(SameBytes(as_it_goes.Assemble(), expected));
    EXPECT_TRUE(SameBytes(mapping.TakeMesh(), expected));
    EXPECT_EQ(mapping.mesh_warning(), "");
}

// The map fills the device memory. The voxels are copied to the host and meshed there, and a
// warning is given.
TEST(MappingStage, MeshesHereWhereTheDeviceHasNoRoomAndSaysSo) {
    int refused = 0;
    constexpr std::size_t kHalfMega = std::size_t{1} << 19;
    for (std::size_t limit = 30 * kHalfMega; limit < 34 * kHalfMega; limit += kHalfMega) {
        DevicePipeline device("host", limit);
        Pipeline pipeline({}, DeskCamera(), {}, &device);
        for (const DeskFrame& frame : DeskFrames()) pipeline.Process(frame.frame);
        const TriangleMesh mesh = pipeline.mapping().Mesh();
        const std::string warning = pipeline.mapping().mesh_warning();
        EXPECT_TRUE(SameBytes(mesh, MeshHere(pipeline.map()))) << limit;
        EXPECT_GT(mesh.triangles.size(), 1000u);
        if (warning.empty()) continue;
        ++refused;
        EXPECT_NE(warning.find("meshed on the CPU"), std::string::npos) << warning;
        EXPECT_NE(warning.find("mapping.device_memory_mb"), std::string::npos) << warning;
    }
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, 4);
}

}  // namespace
}  // namespace tessera::host
