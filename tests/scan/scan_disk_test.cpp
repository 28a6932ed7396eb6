// The scan file on a disk that fails at every single operation, and after power cuts. Oracle: the
// scan holds a whole checkpoint, and none that was reported as written is lost.
#include <cstdlib>
#include <filesystem>

#include "scan/faulty_disk.h"
#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

// A run that writes into one scan. Checkpoint c writes every block and ten new poses.
class Scanning {
  public:
    Scanning(const std::string& path, int blocks)
        : path_(path),
          map_(BlockMap::Config{.voxel_size_m = 0.02, .truncation_m = 0.08}),
          ids_(Ids(map_, blocks)) {}

    // The number of checkpoints that were reported as written, the first one included.
    std::int64_t written() const { return written_; }

    Status Open() {
        const bool exists = std::filesystem::exists(path_);
        Result<std::unique_ptr<ScanFile>> file =
            exists ? ScanFile::OpenToWrite(path_) : ScanFile::Create(path_, SmallMeta().Encode());
        if (!file.ok()) return file.status();
        writer_ = std::make_unique<ScanWriter>(std::move(file.value()), 5000);
        return Status::Ok();
    }

    Status WriteOne() {
        const int c = static_cast<int>(written_) + 1;
        for (const BlockId id : ids_) FillBlock(map_, id, Seed(c, id));
        ScanCheckpoint checkpoint;
        checkpoint.blocks.Copy(map_, ids_);
        for (int i = 10 * (c - 1); i < 10 * c; ++i)
            checkpoint.path.emplace_back(i, RecordOfFrame(i));
        checkpoint.progress.frames = 10 * c;
        checkpoint.progress.last_index = 10 * c - 1;
        const Status status = writer_->Write(checkpoint);
        if (status.ok()) ++written_;
        return status;
    }

    void Close() {
        writer_->Close();
        writer_.reset();
    }
    void Drop() { writer_.reset(); }

    // Checks everything in a scan, which may lie elsewhere, and returns its checkpoint.
    std::int64_t Check(const std::string& path) {
        Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(path);
        EXPECT_TRUE(file.ok()) << file.message();
        if (!file.ok()) return -1;
        const std::int64_t c = file.value()->seal().checkpoint;
        file.value().reset();
        Result<ScanContent> scan = ReadScan(path, {});
        EXPECT_TRUE(scan.ok()) << scan.message();
        if (!scan.ok()) return -1;
        EXPECT_EQ(scan.value().path.size(), static_cast<std::size_t>(10 * c));
        for (const BlockId id : ids_)
            if (c > 0) FillBlock(map_, id, Seed(static_cast<int>(c), id));
        EXPECT_TRUE(c == 0 ? scan.value().map->size() == 1 : SameMap(*scan.value().map, map_));
        return c;
    }

  private:
    static std::vector<BlockId> Ids(BlockMap& map, int blocks) {
        std::vector<BlockId> ids;
        for (int i = 0; i < blocks; ++i) ids.push_back(map.Allocate(CoordOfBlock(i)));
        return ids;
    }
    static std::uint32_t Seed(int checkpoint, BlockId id) {
        return static_cast<std::uint32_t>(1000 * checkpoint) + static_cast<std::uint32_t>(id);
    }

    std::string path_;
    BlockMap map_;
    std::vector<BlockId> ids_;
    std::unique_ptr<ScanWriter> writer_;
    std::int64_t written_ = 0;
};

struct FaultKind {
    const char* name;
    DiskFault fault;
    bool lasting;
};

class FailingDisk : public testing::TestWithParam<FaultKind> {};

TEST_P(FailingDisk, AtAnyOperationNothingThatWasReportedAsWrittenIsLost) {
    FaultyDisk disk;
    int failures = 0;
    std::size_t operations = 1;
    for (std::size_t at = 0; at <= operations; ++at) {
        // The first run is a whole one, to know how many operations there are.
        TempFolder folder;
        const std::string path = folder / "a.scan";
        Scanning run(path, 6);
        disk.Start(folder.path());
        if (at > 0) disk.FailAt(at - 1, GetParam().fault, GetParam().lasting);
        Status status = run.Open();
        const bool opened = status.ok();
        while (status.ok() && run.written() < 4) status = run.WriteOne();
        const bool reported = !status.ok();
        if (reported) {
            EXPECT_EQ(status.message().find(path), 0u) << status.message();
            EXPECT_EQ(status.message().find('\n'), std::string::npos) << status.message();
        }
        if (opened) run.Close();
        if (at == 0) operations = disk.operations();
        failures += disk.failed();
        disk.Mend();
        // A scan that was never begun leaves nothing that keeps the next one from its name.
        if (!std::filesystem::exists(path)) {
            EXPECT_EQ(run.written(), 0);
            const auto next = ScanFile::Create(path, SmallMeta().Encode());
            EXPECT_TRUE(next.ok()) << next.message();
            continue;
        }
        const std::int64_t held = run.Check(path);
        EXPECT_GE(held, run.written()) << "operation " << at - 1;
        EXPECT_LE(held, run.written() + reported) << "operation " << at - 1;
        // And the scan can be continued.
        ASSERT_TRUE(run.Open().ok());
        EXPECT_TRUE(testing::Test::HasFailure() || held != run.written() || run.WriteOne().ok());
        run.Close();
    }
    EXPECT_GT(failures, 100);
    RecordProperty("failures", failures);
}

INSTANTIATE_TEST_SUITE_P(ScanDisk, FailingDisk,
                         testing::Values(FaultKind{"Full", DiskFault::kFull, true},
                                         FaultKind{"FullOnce", DiskFault::kFull, false},
                                         FaultKind{"Error", DiskFault::kWriteError, true},
                                         FaultKind{"ErrorOnce", DiskFault::kWriteError, false},
                                         FaultKind{"Gone", DiskFault::kGone, true}),
                         [](const auto& kind) { return std::string(kind.param.name); });

// TESSERA_POWER_CUTS=1000 for more.
TEST(ScanDisk, APowerCutLosesNothingThatWasReportedAsWritten) {
    const char* asked = std::getenv("TESSERA_POWER_CUTS");
    const int cuts = asked != nullptr ? std::atoi(asked) : 150;
    TempFolder folder;
    std::filesystem::create_directory(folder / "run");
    Scanning run(folder / "run/a.scan", 100);
    ASSERT_TRUE(run.Open().ok());
    ASSERT_TRUE(run.WriteOne().ok());
    run.Drop();
    FaultyDisk disk;
    disk.Start(folder / "run");
    // Enough that SQLite moves its journal into the file and begins it anew.
    std::vector<std::size_t> reported(2, 0);  // operations when a checkpoint was reported
    ASSERT_TRUE(run.Open().ok());
    for (int i = 0; i < 80; ++i) {
        ASSERT_TRUE(run.WriteOne().ok());
        reported.push_back(disk.operations());
    }
    EXPECT_GE(disk.WritesAt("a.scan-wal", 0), 2u);  // the journal's beginning
    run.Close();
    const std::size_t operations = disk.operations();
    std::mt19937 random(7);
    int lost = 0;
    for (int cut = 0; cut < cuts && !HasFailure(); ++cut) {
        // Some of them in the last operations, when the journal goes.
        const std::size_t at = cut % 5 == 0 ? operations - random() % (operations - reported.back())
                                            : random() % operations;
        disk.MakeAfterPowerCut(at, static_cast<std::uint32_t>(cut), folder / "cut");
        const std::int64_t held = run.Check(folder / "cut/a.scan");
        const std::int64_t promised =
            std::upper_bound(reported.begin(), reported.end(), at) - reported.begin() - 1;
        EXPECT_GE(held, promised) << "cut " << cut << " after operation " << at;
        EXPECT_LE(held, promised + 1);
        lost += held == promised;
    }
    EXPECT_GT(lost, cuts / 2);  // most cuts hit a checkpoint while it was being written
}

}  // namespace
}  // namespace tessera
