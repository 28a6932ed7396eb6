// Bit flips and truncations with fixed seeds. There must be no crash and no wrong map, and intact
// data must be recovered.
#include <filesystem>
#include <set>

#include "scan/scan_repair.h"
#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

// Overwrites one byte in place and restores it. Rewriting the file a thousand times would be slow.
class WrongByte {
  public:
    WrongByte(const std::string& path, std::size_t at, char wrong, char right)
        : file_(path, std::ios::in | std::ios::out | std::ios::binary), at_(at), right_(right) {
        Put(wrong);
    }
    ~WrongByte() { Put(right_); }

  private:
    void Put(char byte) { file_.seekp(static_cast<std::streamoff>(at_)).put(byte).flush(); }

    std::fstream file_;
    std::size_t at_;
    char right_;
};

class ScanDamage : public testing::Test {
  protected:
    ScanDamage()
        : owned(WriteSmallScan(folder / "a.scan")),
          map(*owned),
          whole(ReadBytes(folder / "a.scan")) {
        Result<ScanContent> scan = ReadScan(folder / "a.scan", {});
        EXPECT_TRUE(scan.ok());
        path = scan.value().path;
    }

    // Returns true if the file was read. It must then be identical to the original.
    bool ReadIsRightOrRefused(const std::string& file) {
        Result<ScanContent> scan = ReadScan(file, {.map = true, .frames = true});
        if (!scan.ok()) {
            EXPECT_EQ(scan.message().find('\n'), std::string::npos) << scan.message();
            return false;
        }
        EXPECT_TRUE(SameMap(*scan.value().map, map));
        EXPECT_TRUE(SamePath(scan.value().path, path));
        return true;
    }

    // A repaired file must be readable, and each of its blocks and poses must exist in the
    // original. Returns the number of blocks.
    std::int64_t ExpectSoundRepair(const std::string& file) {
        const std::string out = folder / "repaired.scan";
        std::filesystem::remove(out);
        const Result<RepairReport> report = RepairScan(file, out);
        if (!report.ok()) return 0;
        Result<ScanContent> scan = ReadScan(out, {.map = true, .frames = true});
        EXPECT_TRUE(scan.ok()) << scan.message();
        if (!scan.ok()) return 0;
        const BlockMap& found = *scan.value().map;
        EXPECT_EQ(found.size() - 1, report.value().blocks);
        for (BlockId id = 1; id < found.size(); ++id) {
            const BlockId original = map.Find(found.coord(id));
            EXPECT_TRUE(original != kUnknownBlock &&
                        (original == 1 || SameBlock(found, id, map, original)))
                << id;
        }
        EXPECT_LE(scan.value().path.size(), path.size());
        return report.value().blocks;
    }

    TempFolder folder;
    std::unique_ptr<BlockMap> owned;
    const BlockMap& map;
    std::string whole;
    std::vector<PathRecord> path;
};

TEST_F(ScanDamage, AThousandBitFlips) {
    std::mt19937 random(20240901);
    WriteBytes(folder / "b.scan", whole);
    int refused = 0, repaired = 0;
    std::int64_t blocks = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::size_t at = random() % whole.size();
        const WrongByte wrong(folder / "b.scan", at,
                              static_cast<char>(whole[at] ^ (1 << random() % 8)), whole[at]);
        const bool read = ReadIsRightOrRefused(folder / "b.scan");
        refused += !read;
        if (i % 50 != 0) continue;
        ++repaired;
        blocks += ExpectSoundRepair(folder / "b.scan");
    }
    EXPECT_GT(refused, 200);           // the other flips hit free space
    EXPECT_GE(blocks, repaired * 35);  // of 36 blocks: a flip costs at most one
}

TEST_F(ScanDamage, EveryByteOfTheHeaderAndTheFirstPages) {
    WriteBytes(folder / "b.scan", whole);
    for (std::size_t at = 0; at < 200; ++at) {
        const WrongByte wrong(folder / "b.scan", at, static_cast<char>(~whole[at]), whole[at]);
        ReadIsRightOrRefused(folder / "b.scan");
    }
}

TEST_F(ScanDamage, Truncations) {
    std::mt19937 random(7);
    std::int64_t most = 0;
    for (int i = 0; i < 40; ++i) {
        WriteBytes(folder / "b.scan", whole.substr(0, random() % whole.size()));
        ReadIsRightOrRefused(folder / "b.scan");
        if (i % 4 == 0) most = std::max(most, ExpectSoundRepair(folder / "b.scan"));
    }
    EXPECT_GT(most, 20);
}

TEST_F(ScanDamage, AHeaderOfZerosAndTablesThatAreNoneAreRepaired) {
    std::string bytes = whole;
    std::fill(bytes.begin(), bytes.begin() + 16384, '\0');
    WriteBytes(folder / "b.scan", bytes);
    EXPECT_FALSE(ReadIsRightOrRefused(folder / "b.scan"));
    EXPECT_EQ(ExpectSoundRepair(folder / "b.scan"), 36);
    const Result<ScanContent> scan = ReadScan(folder / "repaired.scan", {});
    EXPECT_TRUE(SameMap(*scan.value().map, map));
    EXPECT_TRUE(SamePath(scan.value().path, path));
}

// After a process is killed the journal holds the last checkpoints. If it is cut anywhere, the file
// is in the state of one of the checkpoints.
TEST_F(ScanDamage, ACutJournalIsAnEarlierCheckpoint) {
    std::string copy_from = folder / "d.scan";
    auto file = ScanFile::Create(copy_from, SmallMeta().Encode());
    ASSERT_TRUE(file.ok());
    for (int c = 0; c < 4; ++c) {
        file.value()->Begin();
        for (int i = 0; i < 5; ++i)
            file.value()->Put(ScanTable::kPath, 5 * c + i, RecordOfFrame(5 * c + i).Encode());
        const ScanProgress progress{5 * (c + 1), 1, 0, 5 * c + 4, 0, false};
        file.value()->Put(ScanStateKey::kProgress, progress.Encode());
        ASSERT_TRUE(file.value()->Commit(false).ok());
    }
    const std::string main = ReadBytes(copy_from), journal = ReadBytes(copy_from + "-wal");
    ASSERT_GT(journal.size(), 16384u);
    std::mt19937 random(3);
    std::set<std::size_t> lengths;
    for (int i = 0; i < 60; ++i) {
        std::filesystem::remove(folder / "e.scan-shm");
        WriteBytes(folder / "e.scan", main);
        WriteBytes(folder / "e.scan-wal",
                   journal.substr(0, i == 0 ? journal.size() : random() % journal.size()));
        const Result<ScanContent> scan = ReadScan(folder / "e.scan", {});
        ASSERT_TRUE(scan.ok()) << scan.message();
        EXPECT_EQ(scan.value().path.size() % 5, 0u);
        lengths.insert(scan.value().path.size());
    }
    EXPECT_TRUE(lengths.contains(20u) && lengths.size() >= 4);
}

}  // namespace
}  // namespace tessera
