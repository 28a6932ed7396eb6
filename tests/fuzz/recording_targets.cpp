// Recordings of other programs. The rest (.bag, .mkv, .r3d, folders) is damaged by the tests of its
// reader, because its files come from other programs.
#include "fuzz/fuzz_target.h"
#include "recordings/lzfse.h"
#include "recordings/lzfse_encoder.h"
#include "recordings/recording_source.h"
#include "recordings/ros2_writer.h"
#include "recordings/ros_recording.h"
#include "recordings/sens_recording.h"
#include "recordings/sens_writer.h"

namespace tessera::fuzz {
namespace {

// Reads at most so many frames: damage can make one frame look like many.
void ReadRecording(RecordingResult recording, const std::string& path) {
    constexpr int kMostFrames = 20;
    CheckError(recording.status(), path);
    if (!recording.ok()) return;
    const auto source = MakeRecordingSource(path, std::move(recording.value()), {});
    CheckError(source.status(), path);
    if (!source.ok()) return;
    const PinholeCamera& camera = source.value()->info().camera;
    Frame frame;
    for (int i = 0; i < kMostFrames; ++i) {
        const ReadResult read = source.value()->Read(frame);
        if (read.status == ReadStatus::kEnd) return;
        if (read.status == ReadStatus::kSkip) CheckError(Status::Error(read.message), path);
        if (read.status != ReadStatus::kOk) continue;
        TESSERA_CHECK(frame.depth_m.width() == camera.width && frame.depth_m.size() > 0 &&
                          (frame.colour.empty() || frame.colour.width() == camera.width),
                      "{} and {} pixels wide", frame.depth_m.width(), frame.colour.width());
    }
}

std::vector<Bytes> McapSeeds() {
    const std::vector<ros_test::Message> all = ros_test::PlainMessages();
    const std::vector<ros_test::Message> some(all.begin(), all.begin() + 5);  // one pair
    return {BytesOf(McapOf(some, "")), BytesOf(McapOf(some, "lz4")), BytesOf(McapOf(some, "zstd"))};
}

std::vector<Bytes> SensSeeds() {
    Image<std::uint16_t> depth(32, 24, 1500);
    const ColourImage colour(64, 48, {10, 20, 30});
    SensTestFile raw, packed;
    raw.colour_kind = raw.depth_kind = 0;
    for (std::uint64_t i = 1; i < 3; ++i) {
        raw.frames.push_back({33333 * i, 33333 * i, SensTestRaw(colour), SensTestRaw(depth)});
        packed.frames.push_back({33333 * i, 33333 * i, SensTestJpeg(colour), SensTestZlib(depth)});
    }
    return {BytesOf(raw.Bytes()), BytesOf(packed.Bytes())};
}

std::vector<Bytes> LzfseSeeds() {
    Bytes text;
    for (int i = 0; i < 3000; ++i) text.push_back(static_cast<std::uint8_t>(i * i / 97 % 251));
    std::vector<Bytes> seeds;
    for (const LzfseBlock kind :
         {LzfseBlock::kRaw, LzfseBlock::kLzvn, LzfseBlock::kWide, LzfseBlock::kPacked})
        seeds.push_back(EncodeLzfse(text, {kind}));
    return seeds;
}

}  // namespace

std::vector<FuzzTarget> RecordingTargets() {
    const auto read_with = [](RecordingResult (*open)(const std::string&)) {
        return [open](std::span<const std::uint8_t> bytes) {
            const BytesAsFile file(bytes);
            ReadRecording(open(file.path()), file.path());
        };
    };
    const auto open_mcap = [](const std::string& path) { return OpenRosRecording(path, 0.02); };
    return {{"mcap", McapSeeds, read_with(open_mcap), 500},
            {"sens", SensSeeds, read_with(OpenSensRecording), 500},
            {"lzfse", LzfseSeeds, [](std::span<const std::uint8_t> bytes) {
                 Bytes out(3000);
                 (void)DecodeLzfse(bytes, out);
             }}};
}

}  // namespace tessera::fuzz
