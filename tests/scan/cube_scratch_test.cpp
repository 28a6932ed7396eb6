#include "scan/cube_scratch.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

// A map of `blocks` blocks of random voxels. `seed` makes maps distinguishable.
std::unique_ptr<BlockMap> MapOf(int blocks, std::uint32_t seed) {
    auto map =
        std::make_unique<BlockMap>(BlockMap::Config{.voxel_size_m = 0.02, .truncation_m = 0.08});
    for (int i = 0; i < blocks; ++i)
        FillBlock(*map, map->Allocate(CoordOfBlock(i)), seed + static_cast<std::uint32_t>(i));
    return map;
}

std::map<std::int64_t, std::vector<BlockId>> ByCube(const BlockMap& map) {
    std::map<std::int64_t, std::vector<BlockId>> cubes;
    for (BlockId id = 1; id < map.size(); ++id) cubes[CubeKey(CubeOf(map.coord(id)))].push_back(id);
    return cubes;
}

void PutAll(const BlockMap& map, CubeScratch& store) {
    BlockCopies copies;
    for (const auto& [key, ids] : ByCube(map)) {
        copies.Copy(map, ids);
        ASSERT_TRUE(store.Put(key, copies).ok());
    }
}

TEST(CubeScratch, GivesBackWhatWasPutLastAndLeavesNoFile) {
    TempFolder folder;
    auto store = CubeScratch::Create(folder / "a.scan");
    ASSERT_TRUE(store.ok()) << store.message();
    PutAll(*MapOf(30, 1), *store.value());
    const auto owned = MapOf(60, 1000);  // replaces the first blocks and adds more
    const BlockMap& map = *owned;
    PutAll(map, *store.value());
    BlockCopies copies;
    std::size_t blocks = 0;
    for (const auto& [key, ids] : ByCube(map)) {
        ASSERT_EQ(store.value()->Count(key), static_cast<std::int32_t>(ids.size()));
        ASSERT_TRUE(store.value()->Read(key, copies).ok());
        ASSERT_EQ(copies.size(), ids.size());
        BlockMap again(map.config());
        for (std::size_t i = 0; i < copies.size(); ++i) {
            const BlockId id = again.Allocate(copies.coords[i], copies.numbers[i]),
                          expected = map.Find(copies.coords[i]);
            copies.Put(i, again, id);
            EXPECT_EQ(copies.numbers[i], map.number(expected));
            EXPECT_TRUE(SameBlock(again, id, map, expected));
        }
        blocks += ids.size();
    }
    EXPECT_EQ(blocks, 60u);
    EXPECT_EQ(store.value()->Count(CubeKey({100, 100, 100})), 0);
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(CubeScratch, SaysWhereItCannotBeMade) {
    const auto store = CubeScratch::Create("/no/such/folder/a.scan");
    ASSERT_FALSE(store.ok());
    EXPECT_NE(store.message().find("/no/such/folder/a.scan"), std::string::npos);
}

// A child process replaces all blocks of a file with one map after the other until it is killed: in
// even turns just as a replacement starts, in odd turns just after it ends. Consecutive maps differ
// in every block and in the number of blocks. The file must hold exactly one of the two.
TEST(CubeScratch, AFileThatIsKilledHasTheOneMapOrTheOther) {
    constexpr int kBlocks[] = {150, 90};
    constexpr std::uint32_t kSeeds[] = {1, 5000};
    TempFolder folder;
    std::set<std::int64_t> seen;
    for (int turn = 0; turn < 12; ++turn) {
        const std::string path = folder / (std::to_string(turn) + ".scan");
        WriteSmallScan(path);
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        if (child == 0) {
            const auto tell = [&] {
                if (write(ends[1], "x", 1) != 1) _exit(3);
            };
            auto file = ScanFile::OpenToWrite(path);
            if (!file.ok()) _exit(1);
            ScanWriter writer(std::move(file.value()), 5000);
            const ScanProgress progress{30, 30, 0, 29, 29 / 30.0, false};
            for (int i = 0;; ++i) {
                auto store = CubeScratch::Create(path);
                PutAll(*MapOf(kBlocks[i % 2], kSeeds[i % 2]), *store.value());
                ScanCheckpoint checkpoint;
                checkpoint.clear_blocks = true;
                checkpoint.stored = std::move(store.value());
                checkpoint.progress = progress;
                tell();
                if (!writer.Write(checkpoint).ok()) _exit(2);
                tell();
            }
        }
        close(ends[1]);
        char told;
        for (int i = 0; i <= turn; ++i)
            ASSERT_EQ(read(ends[0], &told, 1), 1) << "the child exited early";
        close(ends[0]);
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const auto scan = ReadScan(path, {});
        ASSERT_TRUE(scan.ok()) << scan.message();
        const BlockMap& map = *scan.value().map;
        seen.insert(map.count());
        if (map.count() == 36) continue;  // killed before the first replacement: unchanged
        const int which = map.count() == kBlocks[0] ? 0 : 1;
        const auto expected = MapOf(kBlocks[which], kSeeds[which]);
        ASSERT_EQ(map.count(), expected->count());
        for (BlockId id = 1; id < map.size(); ++id)
            ASSERT_TRUE(SameBlock(map, id, *expected, expected->Find(map.coord(id))));
    }
    EXPECT_GE(seen.size(), 2u) << "every kill left the same map";
}

}  // namespace
}  // namespace tessera
