// What repair believes of a journal, and what it does without the states of a scan.
#include "scan/scan_repair.h"

#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

class ScanRepair : public testing::Test {
  protected:
    ScanRepair() : map(WriteSmallScan(folder / "a.scan")) {}

    // Begins another checkpoint.
    void Open() {
        Result<std::unique_ptr<ScanFile>> opened = ScanFile::OpenToWrite(folder / "a.scan");
        ASSERT_TRUE(opened.ok()) << opened.message();
        file = std::move(opened.value());
        file->Begin();
        ASSERT_TRUE(file->error().ok());
    }
    void Put(ScanTable table, std::int64_t key, const Bytes& data) {
        file->Put(table, key, data);
        ASSERT_TRUE(file->error().ok());
    }
    void Commit(const ScanProgress& progress) {
        file->Put(ScanStateKey::kProgress, progress.Encode());
        ASSERT_TRUE(file->Commit(true).ok());
        file->Close();
    }
    // As after a kill: the file and its journal. SQLite does not know the copy.
    void CopyOpenFile(const std::string& behind_the_journal = "") {
        WriteBytes(folder / "b.scan", ReadBytes(folder / "a.scan"));
        WriteBytes(folder / "b.scan-wal", ReadBytes(folder / "a.scan-wal") + behind_the_journal);
    }
    // The new scan has all blocks. Returns the rest.
    ScanContent Repair(const std::string& name, const ScanParts& parts = {}) {
        const auto report = RepairScan(folder / name, folder / "new.scan");
        EXPECT_TRUE(report.ok()) << report.message();
        if (!report.ok()) return {};
        lost = report.value().lost;
        Result<ScanContent> scan = ReadScan(folder / "new.scan", parts);
        EXPECT_TRUE(scan.ok()) << scan.message();
        if (!scan.ok()) return {};
        EXPECT_TRUE(SameMap(*scan.value().map, *map));
        return std::move(scan.value());
    }

    TempFolder folder;
    std::unique_ptr<BlockMap> map;
    std::unique_ptr<ScanFile> file;
    std::vector<std::string> lost;
};

// SQLite writes pages of a large checkpoint to the journal before it is complete.
TEST_F(ScanRepair, IgnoresACheckpointThatWasNotCompleted) {
    Open();
    file->Clear(ScanTable::kBlocks);
    for (int key = 0; key < 1400; ++key) Put(ScanTable::kBlocks, key, Bytes(15'000, 1));
    ASSERT_GT(ReadBytes(folder / "a.scan-wal").size(), 1'000'000u);
    CopyOpenFile();
    Repair("b.scan");
    EXPECT_TRUE(lost.empty());
}

// When SQLite writes the journal again from its beginning, the old frames stay behind the new ones.
TEST_F(ScanRepair, IgnoresTheRemainsOfAnEarlierJournal) {
    constexpr std::size_t kJournalHeader = 32, kFrameHeader = 24;
    constexpr std::size_t kFrame = kFrameHeader + kScanPageBytes;
    Open();
    const Bytes tracking(50'000, 7);  // on several pages
    file->Put(ScanStateKey::kTracking, tracking);
    ASSERT_TRUE(file->Commit(false).ok());
    std::string remains = ReadBytes(folder / "a.scan-wal").substr(kJournalHeader);
    ASSERT_EQ(remains.size() % kFrame, 0u);
    ASSERT_GT(remains.size(), 3 * kFrame);
    for (std::size_t at = 0; at < remains.size(); at += kFrame) {
        remains[at + 8] = static_cast<char>(~remains[at + 8]);  // the salt
        std::fill_n(remains.data() + at + kFrameHeader, kScanPageBytes, '\0');
    }
    CopyOpenFile(remains);
    EXPECT_EQ(Repair("b.scan").tracking, tracking);
    EXPECT_TRUE(lost.empty());
}

TEST_F(ScanRepair, LeavesOutLabelsWhoseObjectsAreLost) {
    map->EnableLabels();
    std::vector<BlockId> ids;
    for (BlockId id = 1; id < map->size(); ++id) {
        map->label(id)->instance = 3;
        ids.push_back(id);
    }
    BlockCopies blocks;
    blocks.Copy(*map, ids);
    BlockCodec codec;
    Open();
    for (std::size_t i = 0; i < ids.size(); ++i)
        Put(ScanTable::kBlocks, BlockKey(blocks.coords[i]), codec.Encode(blocks, i));
    Commit({30, 30, 0, 29, 1.0, true});
    const ScanContent scan = Repair("a.scan", {.labels = true});
    EXPECT_EQ(lost, std::vector<std::string>{"the objects' labels"});
    EXPECT_FALSE(scan.progress.labels);
    for (const BlockId id : ids) EXPECT_EQ(scan.map->label(id)->instance, 0);
}

TEST_F(ScanRepair, ForgetsHowFarASourceWasReadWhoseNameIsLost) {
    Open();
    for (int i = 0; i < 10; ++i) Put(ScanTable::kPath, 30 + i, RecordOfFrame(i).Encode());
    Commit({40, 40, 0, 9, 0.3, false});
    const ScanContent scan = Repair("a.scan");
    EXPECT_EQ(lost, std::vector<std::string>{"the name of the last session's source"});
    EXPECT_EQ(scan.progress.last_index, -1);
    EXPECT_EQ(scan.path.size(), 40u);
}

}  // namespace
}  // namespace tessera
