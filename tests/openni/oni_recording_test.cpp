// Tests of .oni files, recorded by OpenNI2 from the test device and read back.
#include <cstdlib>
#include <filesystem>

#include "io/temporary_folder.h"
#include "openni/openni_fixture.h"

namespace tessera {
namespace {

class OniRecording : public OpenniTest {
  protected:
    // Records `frames` frames of the device into a file, which is closed on return.
    static Log Record(const std::string& path, std::size_t frames, bool lossless) {
        const auto source = Open();
        if (!source) return {};
        const Status status = source->RecordTo(path, lossless);
        EXPECT_TRUE(status.ok()) << status.message();
        return ReadFrames(*source, frames);
    }
};

TEST_F(OniRecording, IsReadBackBitForBit) {
    TemporaryFolder folder;
    Set("PACE", "real");
    const Log given = Record(folder.Path("a.oni"), 12, true);
    const auto source = Open(folder.Path("a.oni"));
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->info().kind, ".oni recording");
    EXPECT_FALSE(source->info().live);
    EXPECT_NEAR(source->info().camera.fx, 525, 1e-3);
    EXPECT_GE(source->info().frame_count, 10);
    const Log log = ReadFrames(*source, 1000);
    EXPECT_TRUE(log.ended);
    EXPECT_TRUE(log.skips.empty());
    ASSERT_GE(log.frames.size(), 10u);
    EXPECT_EQ(static_cast<std::int64_t>(log.frames.size()), source->info().frame_count);
    ExpectIncreasingStamps(log.frames);
    // The recorder starts a frame or two after the source. It restarts the clock of each stream at
    // that stream's first frame. On a busy machine the two streams may start at different frames.
    const auto first_of = [](const auto& is) {
        int first = 0;
        while (first < 12 && !is(first)) ++first;
        return first;
    };
    const int depth =
        first_of([&](int i) { return Millimetres(log.frames[0]) == ExpectedDepth(i); });
    const int colour = first_of([&](int i) { return log.frames[0].colour == ExpectedColour(i); });
    ASSERT_LT(depth, 12);
    ASSERT_LT(colour, 12);
    EXPECT_LE(std::abs(depth - colour), 2);
    for (const Frame& frame : log.frames) {
        EXPECT_EQ(Millimetres(frame),
                  ExpectedDepth(depth + NumberOf(frame, log.frames[0].stamp_s)));
        EXPECT_EQ(frame.colour, ExpectedColour(colour + NumberOf(frame, log.frames[0].stamp_s)));
    }
    Frame frame;
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
}

TEST_F(OniRecording, PlaysAtTheRecordedPaceIfTold) {
    TemporaryFolder folder;
    Set("PACE", "real");
    Record(folder.Path("a.oni"), 8, false);
    OpenniConfig config;
    config.playback = OpenniConfig::Playback::kRecorded;
    const auto source = Open(folder.Path("a.oni"), config);
    ASSERT_NE(source, nullptr);
    EXPECT_TRUE(source->info().live);
    const Log log = ReadFrames(*source, 1000);
    EXPECT_TRUE(log.ended);
    EXPECT_GE(log.frames.size(), 4u);
}

TEST_F(OniRecording, EndsWhenTheCameraIsUnplugged) {
    TemporaryFolder folder;
    Set("PACE", "real");
    Set("VANISH_AT", 8);
    Set("BACK_MS", 100);
    const Log log = Record(folder.Path("a.oni"), 12, false);
    EXPECT_EQ(log.frames.size(), 12u);
    EXPECT_EQ(log.messages,
              (std::vector<std::string>{"camera unplugged, waiting for it; the recording " +
                                            folder.Path("a.oni") + " ends here",
                                        "camera is back"}));
    const auto recorded = Open(folder.Path("a.oni"));
    ASSERT_NE(recorded, nullptr);
    const Log played = ReadFrames(*recorded, 1000);
    EXPECT_GE(played.frames.size(), 5u);
    EXPECT_LE(played.frames.size(), 8u);
}

TEST_F(OniRecording, OnlyCamerasRecordThemselves) {
    TemporaryFolder folder;
    Set("PACE", "real");
    Record(folder.Path("a.oni"), 5, false);
    const auto source = Open(folder.Path("a.oni"));
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->RecordTo("b.oni", true).message(),
              "b.oni: only openni2: cameras can record to .oni; give a folder name to record this "
              "source");
    EXPECT_EQ(Open()->RecordTo("/no/such/folder/c.oni", true).message(),
              "/no/such/folder/c.oni: cannot be written: the folder does not exist; create it or "
              "choose another location");
    EXPECT_EQ(Open()->RecordTo(folder.Path("a.oni"), true).message(),
              folder.Path("a.oni") + ": already exists; give a new name");
}

TEST_F(OniRecording, AFileThatIsNoRecordingIsRefused) {
    TemporaryFolder folder;
    folder.WriteText(
        "text.oni",
        "this is not a recording, but long enough to be read as the head of one ............");
    folder.WriteText("empty.oni", "");
    std::filesystem::create_directory(folder.Path("folder.oni"));
    const auto message = [&](const char* name) {
        return OpenOpenniSource(folder.Path(name), {}).message();
    };
    EXPECT_EQ(message("none.oni"), folder.Path("none.oni") + ": no such file");
    EXPECT_EQ(message("folder.oni"), folder.Path("folder.oni") + ": is a folder; give a file");
    for (const char* name : {"text.oni", "empty.oni"})
        EXPECT_NE(message(name).find("is not an .oni recording"), std::string::npos)
            << message(name);
}

TEST_F(OniRecording, AFileThatIsCutOffIsRefusedOrReadAsFarAsItGoes) {
    TemporaryFolder folder;
    Set("PACE", "real");
    Record(folder.Path("a.oni"), 6, false);
    const auto size = std::filesystem::file_size(folder.Path("a.oni"));
    // The recorder goes on for as long as the camera takes to stop.
    std::size_t recorded = 0;
    {
        const auto whole = OpenOpenniSource(folder.Path("a.oni"), {});
        ASSERT_TRUE(whole.ok()) << whole.message();
        recorded = ReadFrames(*whole.value(), 1000, 60).frames.size();
    }
    for (const std::uintmax_t kept : {std::uintmax_t{20}, size / 2}) {
        const std::string path = folder.Path("cut.oni");
        std::filesystem::copy_file(folder.Path("a.oni"), path,
                                   std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(path, kept);
        const auto source = OpenOpenniSource(path, {});
        if (!source.ok()) {
            EXPECT_EQ(source.message().find(path + ": "), 0u) << source.message();
            EXPECT_EQ(source.message().find('\n'), std::string::npos) << source.message();
            continue;
        }
        const Log log = ReadFrames(*source.value(), 1000, 60);
        EXPECT_TRUE(log.ended) << kept << " of " << size;
        std::vector<std::string> expected = {
            path + ": the recording is truncated; all frames in it were read"};
        // The cut may lie between a depth image and its colour; that depth has no pair.
        if (log.messages.size() == 2)
            expected.push_back(path + ": 1 of " + std::to_string(log.frames.size() + 1) +
                               " depth images had no colour image within 20 ms and were dropped");
        EXPECT_EQ(log.messages, expected);
        EXPECT_LE(log.frames.size(), recorded);
    }
}

}  // namespace
}  // namespace tessera
