#include "recordings/mkv_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <new>

#include "io/image_decoder.h"
#include "io/stamp_pairing.h"
#include "recordings/mkv_cameras.h"
#include "recordings/mkv_images.h"
#include "recordings/mkv_index.h"
#include "recordings/recorded_stamps.h"

namespace tessera {
namespace {

constexpr double kUsualMkvFps = 30;
constexpr double kMostMkvGap_frames = 0.6;  // between depth and its colour

// The images of one track.
struct MkvImages {
    std::string format;
    ImageSize size;
    double fps = 0;  // 0: not said
    std::vector<MkvBlock> blocks;
};

class MkvRecording : public Recording {
  public:
    // Without colour, `colour` has no blocks. `pairs`: indices into the blocks.
    MkvRecording(InputFile file, MkvImages depth, MkvImages colour, std::vector<StampPair> pairs,
                 RecordingInfo info)
        : file_(std::move(file)),
          depth_(std::move(depth)),
          colour_(std::move(colour)),
          pairs_(std::move(pairs)),
          info_(std::move(info)) {}

    const RecordingInfo& info() const override { return info_; }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        TESSERA_CHECK(index < pairs_.size(), "pair {} of {}", index, pairs_.size());
        try {
            return LoadPair(pairs_[index], depth, colour);
        } catch (const std::bad_alloc&) {
            return Status::Error("does not fit in memory");
        }
    }

  private:
    Status LoadPair(const StampPair& pair, Image<std::uint16_t>& depth, ColourImage& colour) {
        if (Status status = Read(depth_.blocks[pair.depth]); !status.ok()) return status;
        if (Status status = DecodeMkvDepth(bytes_, depth_.size, depth); !status.ok())
            return Status::Error("depth " + status.message());
        if (colour_.blocks.empty()) {
            colour.Resize(0, 0);
            return {};
        }
        if (Status status = Read(colour_.blocks[pair.colour]); !status.ok()) return status;
        Status status = DecodeMkvColour(colour_.format, bytes_, colour_.size, colour);
        return status.ok() ? status : Status::Error("colour " + status.message());
    }
    Status Read(const MkvBlock& block) {
        bytes_.resize(block.bytes);
        if (file_.ReadAt(block.offset, bytes_).ok()) return {};
        return Status::Error("cannot be read; the file became shorter meanwhile");
    }

    const InputFile file_;
    const MkvImages depth_, colour_;
    const std::vector<StampPair> pairs_;
    const RecordingInfo info_;
    std::vector<std::uint8_t> bytes_;
};

std::int64_t MkvNumberTag(const MkvIndex& index, const std::string& name, std::int64_t most) {
    const auto tag = index.tags.find(name);
    if (tag == index.tags.end()) return 0;
    const std::string& text = tag->second;
    std::int64_t number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc() && number >= -most && number <= most ? number : 0;
}

// A tag names the track by its number for life; programs that copy tracks may have changed that.
MkvTrack* FindMkvTrack(MkvIndex& index, const std::string& tag, const std::string& name) {
    const auto is_video = [](const MkvTrack& track) { return track.is_video; };
    const auto uid = index.tags.find(tag);
    for (MkvTrack& track : index.tracks)
        if (is_video(track) && uid != index.tags.end() && uid->second == std::to_string(track.uid))
            return &track;
    for (MkvTrack& track : index.tracks)
        if (is_video(track) && track.name == name) return &track;
    return nullptr;
}

Status CheckMkvTrack(const MkvTrack& track, bool (*is_format)(std::string_view)) {
    constexpr auto kMost = static_cast<std::uint64_t>(ImageDecoder::kMaxSide_px);
    if (track.is_packed)
        return Status::Error(
            fmt::format("the track {} is compressed once more; copy it without, "
                        "for example with 'mkvmerge --compression -1:none'",
                        track.name));
    if (!is_format(track.format))
        return Status::Error(
            fmt::format("the track {} has images of the format {}, which k4arecorder does not "
                        "write",
                        track.name, track.format));
    if (track.width < 1 || track.height < 1 || track.width > kMost || track.height > kMost)
        return Status::Error(
            fmt::format("the track {} has {} x {} pixels", track.name, track.width, track.height));
    if (track.blocks.empty())
        return Status::Error(fmt::format("the track {} has no images", track.name));
    return {};
}

MkvImages TakeMkvImages(MkvTrack& track) {
    return {track.format,
            {static_cast<int>(track.width), static_cast<int>(track.height)},
            track.fps,
            std::move(track.blocks)};
}

Result<MkvImages> TakeMkvDepth(MkvIndex& index) {
    MkvTrack* track = FindMkvTrack(index, "K4A_DEPTH_TRACK", "DEPTH");
    if (track == nullptr)
        return Status::Error(
            FindMkvTrack(index, "K4A_IR_TRACK", "IR") != nullptr
                ? "has infrared images, but no depth; record with another depth mode than "
                  "PASSIVE_IR"
                : "is a plain video, without depth; of .mkv files, recordings of the Azure Kinect "
                  "(k4arecorder) are read");
    if (Status status = CheckMkvTrack(*track, IsMkvDepthFormat); !status.ok()) return status;
    return TakeMkvImages(*track);
}

MkvImages TakeMkvColour(MkvIndex& index, RecordingInfo& info) {
    MkvTrack* track = FindMkvTrack(index, "K4A_COLOR_TRACK", "COLOR");
    if (track == nullptr) {
        info.notes.push_back("no colour images");
        return {};
    }
    if (Status status = CheckMkvTrack(*track, IsMkvColourFormat); !status.ok()) {
        info.warnings.push_back("colour is not read: " + status.message());
        return {};
    }
    return TakeMkvImages(*track);
}

std::vector<double> MkvStampsOf(const MkvImages& images, std::int64_t offset_ns) {
    std::vector<double> stamps_s;
    for (const MkvBlock& block : images.blocks)
        stamps_s.push_back(static_cast<double>(block.stamp_ns + offset_ns) / 1e9);
    return stamps_s;
}

std::vector<StampPair> PairMkvImages(const MkvIndex& index, const MkvImages& depth,
                                     const MkvImages& colour, double colour_delay_s,
                                     RecordingInfo& info) {
    constexpr std::int64_t kMostOffset_ns = std::int64_t{1} << 50;
    const std::int64_t offset_ns = MkvNumberTag(index, "K4A_START_OFFSET_NS", kMostOffset_ns);
    const std::int64_t delay_ns = MkvNumberTag(index, "K4A_DEPTH_DELAY_NS", 1'000'000'000);
    const std::vector<double> depth_s = MkvStampsOf(depth, offset_ns),
                              colour_s = MkvStampsOf(colour, offset_ns);
    info.fps = depth.fps >= 1 && depth.fps <= 240 ? depth.fps : 0;
    for (const double stamp_s : depth_s) info.pairs.push_back({stamp_s, stamp_s});
    if (info.fps == 0) info.fps = MedianFps(info.pairs, kUsualMkvFps);
    std::vector<StampPair> pairs;
    info.has_colour = !colour.blocks.empty();
    if (!info.has_colour) {
        for (std::size_t i = 0; i < depth_s.size(); ++i) pairs.push_back({i, 0});
        return pairs;
    }
    const double most_s = kMostMkvGap_frames / info.fps;
    pairs = PairNearest(MkvStampsOf(depth, offset_ns - delay_ns), colour_s, most_s, colour_delay_s);
    info.pairs.clear();
    for (const StampPair& pair : pairs)
        info.pairs.push_back({depth_s[pair.depth], colour_s[pair.colour]});
    if (pairs.size() < depth_s.size())
        info.notes.push_back(
            fmt::format("{} of {} depth images have no colour image within {:.0f} ms and are not "
                        "used",
                        depth_s.size() - pairs.size(), depth_s.size(), 1000 * most_s));
    return pairs;
}

}  // namespace

RecordingResult OpenMkv(const std::string& path, double colour_delay_s) {
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    Result<MkvIndex> index = ReadMkvIndex(file.value());
    if (!index.ok()) return index.status();
    RecordingInfo info;
    info.kind = "Azure Kinect recording";
    info.warnings = index.value().warnings;
    Result<MkvImages> depth = TakeMkvDepth(index.value());
    if (!depth.ok()) return Status::Error(path + ": " + depth.message());
    MkvImages colour = TakeMkvColour(index.value(), info);
    std::vector<StampPair> pairs =
        PairMkvImages(index.value(), depth.value(), colour, colour_delay_s, info);
    if (pairs.empty())
        return Status::Error(path + ": no depth image has a colour image of the same time");
    if (Status status =
            SetMkvCameras(file.value(), index.value(), depth.value().size, colour.size, info);
        !status.ok())
        return Status::Error(path + ": " + status.message());
    return std::unique_ptr<Recording>(
        std::make_unique<MkvRecording>(std::move(file.value()), std::move(depth.value()),
                                       std::move(colour), std::move(pairs), std::move(info)));
}

}  // namespace tessera
