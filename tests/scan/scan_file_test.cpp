#include "scan/scan_file.h"

#include <filesystem>

#include "scan/small_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(ScanFile, GivesBackWhatWasWrittenAndTheBlocksKeepTheirNumbers) {
    TempFolder folder;
    const auto map = WriteSmallScan(folder / "a.scan");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.scan-wal"));
    Result<ScanContent> scan = ReadScan(folder / "a.scan", {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_TRUE(SameMap(*scan.value().map, *map));
    ASSERT_EQ(scan.value().path.size(), 30u);
    for (int i = 0; i < 30; ++i)
        EXPECT_EQ(scan.value().path[static_cast<std::size_t>(i)].Encode(),
                  RecordOfFrame(i).Encode());
    EXPECT_EQ(scan.value().tracking, Bytes(500, 2));
    EXPECT_TRUE(scan.value().finished);
    EXPECT_EQ(scan.value().meta.Encode(), SmallMeta().Encode());
    EXPECT_EQ(scan.value().Path().size(), 26u);
    EXPECT_EQ(scan.value().LastPose()->stamp_s, 29 / 30.0);
}

// A run is killed after a reset, before loop closure has learnt anything of the new world.
TEST(ScanFile, AClearedWorldHasNoLoops) {
    TempFolder folder;
    const ScanMeta meta = SmallMeta();
    Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(folder / "a.scan", meta.Encode());
    ASSERT_TRUE(file.ok()) << file.message();
    ScanWriter writer(std::move(file.value()), 5000);
    ScanCheckpoint checkpoint;
    const PinholeCamera view = meta.camera.Every(kKeyframeReduction);
    for (const int id : {0, 1}) {
        Keyframe& keyframe = checkpoint.keyframes.emplace_back();
        keyframe.id = id;
        keyframe.depth_m = DepthImage(view.width, view.height, 2.0f);
        keyframe.reduced.reduction = 2;
        keyframe.reduced.depth.Resize(meta.camera.width / 2, meta.camera.height / 2);
        checkpoint.poses.emplace_back(id, KeyframePoses());
    }
    checkpoint.loops.emplace().edges.push_back({.from = 0, .to = 1});
    ASSERT_TRUE(writer.Write(checkpoint).ok());
    Result<ScanContent> scan = ReadScan(folder / "a.scan", {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_EQ(scan.value().keyframes.size(), 2u);
    EXPECT_EQ(scan.value().loops.edges.size(), 1u);
    checkpoint.Clear();
    checkpoint.clear_all = true;
    ASSERT_TRUE(writer.Write(checkpoint).ok());
    scan = ReadScan(folder / "a.scan", {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_TRUE(scan.value().keyframes.empty());
    EXPECT_TRUE(scan.value().loops.edges.empty());
}

TEST(ScanFile, AnExistingFileIsNeverOverwritten) {
    TempFolder folder;
    WriteBytes(folder / "a.scan", "mine");
    const auto file = ScanFile::Create(folder / "a.scan", SmallMeta().Encode());
    ASSERT_FALSE(file.ok());
    EXPECT_NE(file.message().find("--resume"), std::string::npos);
    EXPECT_EQ(ReadBytes(folder / "a.scan"), "mine");
}

// The file of a killed run was removed or moved without its journal. SQLite would apply the journal
// to the new file.
TEST(ScanFile, TheJournalOfAFileThatIsGoneIsNotTakenForTheNewOnes) {
    TempFolder folder;
    WriteBytes(folder / "a.scan-wal", "of another");
    const auto file = ScanFile::Create(folder / "a.scan", SmallMeta().Encode());
    ASSERT_FALSE(file.ok());
    EXPECT_NE(file.message().find("a.scan-wal: is the journal"), std::string::npos)
        << file.message();
    EXPECT_EQ(ReadBytes(folder / "a.scan-wal"), "of another");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.scan"));
    std::filesystem::remove(folder / "a.scan-wal");
    EXPECT_TRUE(ScanFile::Create(folder / "a.scan", SmallMeta().Encode()).ok());
}

TEST(ScanFile, TwoRunsCannotWriteIntoOne) {
    TempFolder folder;
    const auto first = ScanFile::Create(folder / "a.scan", SmallMeta().Encode());
    ASSERT_TRUE(first.ok()) << first.message();
    const auto second = ScanFile::OpenToWrite(folder / "a.scan");
    ASSERT_FALSE(second.ok());
    EXPECT_NE(second.message().find("another run"), std::string::npos) << second.message();
    EXPECT_TRUE(ScanFile::OpenToRead(folder / "a.scan").ok());  // reading is still possible
}

TEST(ScanFile, ATransactionThatIsNotCommittedIsNotThere) {
    TempFolder folder;
    {
        auto file = ScanFile::Create(folder / "a.scan", SmallMeta().Encode());
        ASSERT_TRUE(file.ok());
        const Bytes data(100, 7);
        file.value()->Begin();
        file.value()->Put(ScanTable::kPath, 0, data);
        ASSERT_TRUE(file.value()->Commit(false).ok());
        file.value()->Begin();
        file.value()->Clear(ScanTable::kPath);
        file.value()->Put(ScanTable::kPath, 5, data);
        ASSERT_TRUE(file.value()->error().ok());
    }
    auto file = ScanFile::OpenToRead(folder / "a.scan");
    ASSERT_TRUE(file.ok()) << file.message();
    std::vector<std::int64_t> keys;
    ASSERT_TRUE(file.value()
                    ->Read(ScanTable::kPath,
                           [&](const ScanRow& row) {
                               keys.push_back(row.key);
                               return Status::Ok();
                           })
                    .ok());
    EXPECT_EQ(keys, std::vector<std::int64_t>{0});
}

TEST(ScanFile, TheFirstErrorGivesACheckpointUpAndTheNextCanBeWritten) {
    TempFolder folder;
    auto file = ScanFile::Create(folder / "a.scan", SmallMeta().Encode());
    ASSERT_TRUE(file.ok()) << file.message();
    const Bytes data(100, 7);
    file.value()->Begin();
    file.value()->Put(ScanTable::kPath, 0, data);
    file.value()->Abandon(Status::Error("first"));
    file.value()->Abandon(Status::Error("second"));
    file.value()->Put(ScanTable::kPath, 1, data);
    file.value()->Clear(ScanTable::kMeta);
    EXPECT_EQ(file.value()->Commit(false).message(), "first");
    file.value()->Begin();
    file.value()->Put(ScanTable::kPath, 2, data);
    EXPECT_TRUE(file.value()->Commit(false).ok());
    std::vector<std::int64_t> keys;
    for (const ScanTable table : {ScanTable::kMeta, ScanTable::kPath}) {
        const Status read = file.value()->Read(table, [&](const ScanRow& row) {
            keys.push_back(row.key);
            return Status::Ok();
        });
        EXPECT_TRUE(read.ok()) << read.message();
    }
    EXPECT_EQ(keys, (std::vector<std::int64_t>{0, 2}));
}

// Rows that SQLite accepts but that differ from the last checkpoint.
TEST(ScanFile, AMissingAnOldAndAStrangeRowAreFound) {
    TempFolder folder;
    WriteSmallScan(folder / "a.scan");
    const std::string whole = ReadBytes(folder / "a.scan");
    for (const char* crime :
         {"DELETE FROM path WHERE key = 4", "UPDATE path SET key = 99 WHERE key = 29",
          "UPDATE blocks SET data = (SELECT data FROM blocks ORDER BY key LIMIT 1)",
          "UPDATE path SET checkpoint = 0 WHERE key = 4", "DELETE FROM meta", "DROP TABLE frames",
          "DELETE FROM state WHERE key = 0", "DELETE FROM state WHERE key = 1",
          "CREATE VIEW v AS SELECT 1", "INSERT INTO frames VALUES (0, 0, 0, x'00', 1)"}) {
        WriteBytes(folder / "b.scan", whole);
        auto database = Database::Open(folder / "b.scan", Database::Access::kWrite);
        ASSERT_TRUE(database.ok());
        ASSERT_TRUE(database.value()->Execute(crime).ok()) << crime;
        database.value().reset();
        const auto scan = ReadScan(folder / "b.scan", {.map = true, .frames = true});
        ASSERT_FALSE(scan.ok()) << crime;
        EXPECT_NE(scan.message().find("tessera scan repair"), std::string::npos) << scan.message();
    }
}

// A write lost by the disk: each row is valid by itself, but one belongs to an earlier checkpoint.
// Only the seal shows it.
TEST(ScanFile, ARowOfAnEarlierCheckpointIsFound) {
    TempFolder folder;
    WriteSmallScan(folder / "old.scan", 12, 1);
    WriteSmallScan(folder / "a.scan", 12, 3);
    {
        auto database = Database::Open(folder / "a.scan", Database::Access::kWrite);
        ASSERT_TRUE(database.ok());
        ASSERT_TRUE(
            database.value()->Execute("ATTACH '" + (folder / "old.scan") + "' AS old").ok());
        const std::string key = std::to_string(BlockKey(CoordOfBlock(0)));
        ASSERT_TRUE(
            database.value()
                ->Execute("REPLACE INTO main.blocks SELECT * FROM old.blocks WHERE key = " + key)
                .ok());
    }
    const auto scan = ReadScan(folder / "a.scan", {});
    ASSERT_FALSE(scan.ok());
    EXPECT_NE(scan.message().find("some rows are out of date"), std::string::npos)
        << scan.message();
}

TEST(ScanFile, WhatIsNoScanIsRefusedInOneLine) {
    TempFolder folder;
    WriteSmallScan(folder / "a.scan");
    const auto expect = [&](const std::string& path, const char* words) {
        const auto scan = ReadScan(path, {});
        ASSERT_FALSE(scan.ok());
        EXPECT_NE(scan.message().find(words), std::string::npos) << scan.message();
        EXPECT_NE(scan.message().find(path), std::string::npos) << scan.message();
        EXPECT_EQ(scan.message().find('\n'), std::string::npos);
    };
    expect(folder / "no.scan", "no such file");
    expect(folder.path(), "folder");
    WriteBytes(folder / "b.scan", "");
    expect(folder / "b.scan", "not a scan");
    WriteBytes(folder / "b.scan", std::string(100000, 'x'));
    expect(folder / "b.scan", "not a scan");
    const auto change = [&](const char* sql) {
        WriteBytes(folder / "c.scan", ReadBytes(folder / "a.scan"));
        auto database = Database::Open(folder / "c.scan", Database::Access::kWrite);
        ASSERT_TRUE(database.value()->Execute(sql).ok());
    };
    change("PRAGMA user_version = 3");
    expect(folder / "c.scan", "newer tessera");
    change("PRAGMA application_id = 7");
    expect(folder / "c.scan", "another program");
}

TEST(ScanFile, WritingToAnOlderFormatMakesItTheNewest) {
    TempFolder folder;
    WriteSmallScan(folder / "a.scan");
    {
        auto database = Database::Open(folder / "a.scan", Database::Access::kWrite);
        ASSERT_TRUE(database.value()->Execute("PRAGMA user_version = 1").ok());
    }
    const auto version = [&] { return ScanFile::OpenToRead(folder / "a.scan").value()->version(); };
    EXPECT_EQ(version(), 1);
    auto file = std::move(ScanFile::OpenToWrite(folder / "a.scan").value());
    file->Begin();
    ASSERT_TRUE(file->error().ok());
    EXPECT_EQ(version(), 1);
    ASSERT_TRUE(file->Commit(true).ok());
    file->Close();
    EXPECT_EQ(version(), kScanVersion);
}

}  // namespace
}  // namespace tessera
