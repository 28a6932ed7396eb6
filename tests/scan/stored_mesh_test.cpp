#include "scan/stored_mesh.h"

#include "mapping/integrator.h"
#include "scan/small_scan.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using namespace testing_support;

// A room with a ball, fused from several views.
std::unique_ptr<BlockMap> WriteRoom(const std::string& path) {
    auto map =
        std::make_unique<BlockMap>(BlockMap::Config{.voxel_size_m = 0.02, .truncation_m = 0.08});
    const PinholeCamera camera = SmallCamera();
    Integrator integrator({}, camera);
    BoxRoom room;
    room.has_ball = true;
    for (int i = 0; i < 4; ++i) {
        PreparedFrame prepared;
        Integrator::View view;
        view.T_world_camera = SmoothPath(20 * i);
        PrepareFrame(room.Render(camera, view.T_world_camera), {}, prepared);
        integrator.Integrate(prepared, view, *map);
    }
    std::vector<BlockId> all;
    for (BlockId id = 1; id < map->size(); ++id) all.push_back(id);
    ScanWriter writer(std::move(ScanFile::Create(path, SmallMeta().Encode()).value()), 5000);
    ScanCheckpoint checkpoint;
    checkpoint.blocks.Copy(*map, all);
    EXPECT_TRUE(writer.Write(checkpoint).ok());
    writer.Close();
    return map;
}

TEST(StoredMesh, IsThatOfTheWholeMap) {
    TempFolder folder;
    const std::string path = folder / "a.scan";
    const auto map = WriteRoom(path);
    std::size_t triangles = 0;
    for (const int min_triangles : {1, 400}) {
        const MeshConfig meshing{.min_component_triangles = min_triangles};
        Mesher mesher(meshing);
        mesher.Update(*map);
        const TriangleMesh expected = mesher.Assemble();
        ASSERT_GT(expected.triangles.size(), 10000u);
        ASSERT_NE(expected.triangles.size(), triangles);
        triangles = expected.triangles.size();
        const auto mesh = MeshOfStoredMap(path, map->config(), meshing);
        ASSERT_TRUE(mesh.ok()) << mesh.message();
        EXPECT_EQ(mesh.value().vertices, expected.vertices);
        EXPECT_EQ(mesh.value().normals, expected.normals);
        EXPECT_EQ(mesh.value().colours, expected.colours);
        EXPECT_EQ(mesh.value().triangles, expected.triangles);
    }
}

// Two blocks with the same number, or one with a number larger than any. Array sizes must be
// bounded by the number of blocks in the file.
TEST(StoredMesh, NumbersThatNoMapHasAreRefused) {
    for (const std::int32_t number :
         {1, 0, 2'000'000'000, std::numeric_limits<std::int32_t>::max()}) {
        TempFolder folder;
        const std::string path = folder / "a.scan";
        const auto map = WriteSmallScan(path);
        auto file = ScanFile::OpenToWrite(path);
        ASSERT_TRUE(file.ok()) << file.message();
        BlockCopies copies;
        copies.Copy(*map, std::vector<BlockId>{5});
        copies.numbers[0] = number;
        BlockCodec codec;
        file.value()->Begin();
        file.value()->Put(ScanTable::kBlocks, BlockKey(copies.coords[0]), codec.Encode(copies, 0));
        ASSERT_TRUE(file.value()->Commit(true).ok());
        file.value()->Close();
        const auto mesh = MeshOfStoredMap(path, map->config(), {});
        ASSERT_FALSE(mesh.ok()) << number;
        EXPECT_NE(mesh.message().find("tessera scan repair"), std::string::npos) << mesh.message();
    }
}

}  // namespace
}  // namespace tessera
