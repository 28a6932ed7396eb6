#include "scan/cube_reader.h"

#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(Cube, HoldsTheBlocksWhoseKeysFollowItsOwn) {
    for (const BlockCoord& block :
         {BlockCoord{0, 0, 0}, {-1, -8, -9}, {7, 8, 15}, {-kBlockLimit, kBlockLimit - 1, 3}}) {
        const BlockCoord cube = CubeOf(block);
        const std::int64_t key = CubeKey(cube);
        EXPECT_EQ(CubeKeyOf(BlockKey(block)), key);
        EXPECT_EQ(CubeOfKey(key), cube);
        EXPECT_EQ(CubeOf(CoordOfKey(key + kCubeKeys - 1)), cube);
        EXPECT_FALSE(CubeOf(CoordOfKey(key + kCubeKeys)) == cube);
    }
    EXPECT_EQ(CubeOf({-1, -8, -9}), (BlockCoord{-1, -1, -2}));
}

TEST(Cube, AllCubesTogetherAreTheMap) {
    TempFolder folder;
    const std::string path = folder / "a.scan";
    const auto map = WriteSmallScan(path);
    auto reader = CubeReader::Open(path);
    ASSERT_TRUE(reader.ok()) << reader.message();
    const auto cubes = reader.value()->Cubes();
    ASSERT_TRUE(cubes.ok());
    ASSERT_GT(cubes.value().size(), 1u);
    BlockMap again(map->config());
    BlockCopies cube;
    for (const auto& [key, blocks] : cubes.value()) {
        const Status status = reader.value()->Read(key, cube);
        ASSERT_TRUE(status.ok()) << status.message();
        ASSERT_EQ(static_cast<std::int32_t>(cube.size()), blocks);
        for (std::size_t i = 0; i < cube.size(); ++i) {
            ASSERT_EQ(CubeKey(CubeOf(cube.coords[i])), key);
            const BlockId id = again.Allocate(cube.coords[i], cube.numbers[i]);
            cube.Put(i, again, id);
            const BlockId expected = map->Find(cube.coords[i]);
            ASSERT_EQ(again.number(id), map->number(expected));
            ASSERT_TRUE(SameBlock(again, id, *map, expected));
        }
    }
    EXPECT_EQ(again.count(), map->count());
}

TEST(Cube, AChangedRowIsRefused) {
    TempFolder folder;
    const std::string path = folder / "a.scan";
    WriteSmallScan(path);
    auto database = Database::Open(path, Database::Access::kWrite);
    ASSERT_TRUE(database.value()->Execute("UPDATE blocks SET checkpoint = checkpoint + 1").ok());
    auto reader = CubeReader::Open(path);
    ASSERT_TRUE(reader.ok());
    BlockCopies blocks;
    const Status status =
        reader.value()->Read(reader.value()->Cubes().value().front().first, blocks);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("tessera scan repair"), std::string::npos);
}

}  // namespace
}  // namespace tessera
