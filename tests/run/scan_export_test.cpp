#include "run/scan_export.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "export/posed_scan.h"
#include "io/folder_source.h"
#include "run/run_fixture.h"
#include "run/scanned.h"

namespace tessera {
namespace {

using testing_support::kPosedFrames;

// The stamps of the frames in a recorded folder.
std::vector<double> StampsOf(const std::string& folder) {
    const auto source = OpenFolderSource(folder, {});
    EXPECT_TRUE(source.ok()) << source.message();
    return source.ok() ? source.value()->Stamps_s() : std::vector<double>{};
}

std::string StampText(const std::string& folder) {
    std::string text;
    for (const double stamp_s : StampsOf(folder)) text += fmt::format("{:.3f} ", stamp_s);
    return text;
}

class FramesOfScan : public ::testing::Test {
  protected:
    FramesOfScan() { testing_support::WritePosedScan(scan); }

    // Writes rows of frames and of the path over those that are there.
    void Change(const std::function<void(ScanFile&)>& put) const {
        Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToWrite(scan);
        ASSERT_TRUE(file.ok()) << file.message();
        file.value()->Begin();
        put(*file.value());
        ASSERT_TRUE(file.value()->Commit(true).ok());
        file.value()->Close();
    }
    void Damage(std::int64_t frame) const {
        Change([&](ScanFile& file) { file.Put(ScanTable::kFrames, frame, Bytes(9, 1)); });
    }
    void Restamp(std::int64_t frame, double stamp_s) const {
        Change([&](ScanFile& file) {
            FrameRecord record;
            const Result<Bytes> was = file.ReadOne(ScanTable::kFrames, frame);
            ASSERT_TRUE(was.ok() && record.Decode(was.value()));
            record.stamp_s = record.colour_stamp_s = stamp_s;
            file.Put(ScanTable::kFrames, frame, record.Encode().value());
        });
    }

    TempFolder folder;
    const std::string scan = folder / "a.scan", raw = folder / "raw";
};

TEST_F(FramesOfScan, OneSessionIsOneFolder) {
    const auto notes = ExportFrames(scan, raw);
    ASSERT_TRUE(notes.ok()) << notes.message();
    EXPECT_TRUE(notes.value().empty());
    EXPECT_EQ(StampText(raw), "0.000 0.667 1.333 2.000 2.667 ");
    EXPECT_FALSE(std::filesystem::exists(raw + "_2"));
}

TEST_F(FramesOfScan, WhereTheClockStartsAgainAnotherFolderBegins) {
    Restamp(2, 0.5);
    Restamp(4, 2);
    const auto notes = ExportFrames(scan, raw + "/");
    ASSERT_TRUE(notes.ok()) << notes.message();
    EXPECT_EQ(notes.value(),
              (std::vector<std::string>{
                  scan + ": the clock starts again at frame 2; the rest is in " + raw + "_2",
                  scan + ": the clock starts again at frame 4; the rest is in " + raw + "_3"}));
    EXPECT_EQ(StampText(raw), "0.000 0.667 ");
    EXPECT_EQ(StampText(raw + "_2"), "0.500 2.000 ");
    EXPECT_EQ(StampText(raw + "_3"), "2.000 ");
}

TEST_F(FramesOfScan, ADamagedFrameIsLeftOutAndCounted) {
    Damage(1);
    Damage(3);
    const auto notes = ExportFrames(scan, raw);
    ASSERT_TRUE(notes.ok()) << notes.message();
    EXPECT_EQ(notes.value(), std::vector<std::string>{"2 of 5 frames are left out (" + scan +
                                                      ": frame 1: is damaged)"});
    EXPECT_EQ(StampText(raw), "0.000 1.333 2.667 ");
    for (int i = 0; i < kPosedFrames; ++i) Damage(i);
    EXPECT_EQ(ExportFrames(scan, folder / "none").message(),
              scan + ": frame 0: is damaged; no frame can be exported");
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_F(FramesOfScan, AFrameWithoutColourIsLeftOutAndCounted) {
    Change([](ScanFile& file) {
        FrameRecord record;
        const Result<Bytes> was = file.ReadOne(ScanTable::kFrames, 3);
        ASSERT_TRUE(was.ok() && record.Decode(was.value()));
        EncodedImages images = *record.stored.images.Read().value();
        images.colour_jpeg.clear();
        record.stored.images = StoredImages(std::move(images));
        file.Put(ScanTable::kFrames, 3, record.Encode().value());
    });
    const auto notes = ExportFrames(scan, raw);
    ASSERT_TRUE(notes.ok()) << notes.message();
    EXPECT_EQ(notes.value(),
              std::vector<std::string>{"1 of 5 frames are left out (" + scan +
                                       ": frame 3 cannot be recorded: it has no colour)"});
    EXPECT_EQ(StampText(raw), "0.000 0.667 1.333 2.667 ");
}

// The objects that are saved have the names of the first run's classes.
TEST_F(Run, AScanThatIsRefusedForItsClassesStaysAsItIs) {
    request.scan_file = folder / "a.scan";
    request.labels = "synthetic";
    config.labels.classes = "keyboard=#010203 cup=#040506";
    config.labels.min_observations = 2;
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    const auto labels = [&] {
        const auto scan = ReadScan(request.scan_file, {});
        EXPECT_TRUE(scan.ok()) << scan.message();
        return scan.ok() ? scan.value().labels : Bytes();
    };
    const Bytes before = labels();
    ASSERT_FALSE(before.empty());
    request.resume = true;
    config.labels.classes = "book=#010203";
    const auto again = Execute();
    ASSERT_FALSE(again.ok());
    EXPECT_NE(again.message().find("its labels have other classes"), std::string::npos)
        << again.message();
    EXPECT_EQ(labels(), before);
}

// The names that "all" stood for are those of the detector, renamed once.
TEST_F(Run, AScanLabelledWithAllClassesIsExported) {
    request.scan_file = folder / "a.scan";
    request.labels = "synthetic";
    config.labels.classes = "all keyboard=#010203";
    config.labels.aliases = "cup=mug mug=glass";
    config.labels.min_observations = 2;
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_GT(run.value().labels->frames, 0);
    const auto scanned = ReadScanFile(request.scan_file);
    ASSERT_TRUE(scanned.ok()) << scanned.message();
    const TriangleMesh& mesh = scanned.value().mesh;
    EXPECT_GT(mesh.vertices.size(), 100u);
    EXPECT_EQ(mesh.labels.size(), mesh.vertices.size());
}

}  // namespace
}  // namespace tessera
