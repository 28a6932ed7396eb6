#include "recordings/ros_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "io/stamp_pairing.h"
#include "recordings/endings.h"
#include "recordings/recorded_stamps.h"
#include "recordings/ros_images.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

using MessageFiles = std::vector<std::unique_ptr<MessageFile>>;

std::vector<double> StampsOf(const RosStream& stream) {
    std::vector<double> stamps_s;
    for (const RosImagePlace& image : stream.images) stamps_s.push_back(image.stamp_s);
    return stamps_s;
}

std::vector<StampPair> PairsOf(const RosChoice& choice, double max_gap_s, double colour_delay_s) {
    const std::vector<double> depth_s = StampsOf(*choice.depth);
    if (choice.colour != nullptr) {
        const std::vector<double> colour_s = StampsOf(*choice.colour);
        return PairNearest(depth_s, colour_s, PairGap(max_gap_s, depth_s, colour_s),
                           colour_delay_s);
    }
    std::vector<StampPair> pairs(depth_s.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {i, i};
    return pairs;
}

class RosRecording : public Recording {
  public:
    RosRecording(MessageFiles files, RosContents contents, const RosChoice& choice,
                 std::vector<StampPair> pairs, RecordingInfo info)
        : files_(std::move(files)),
          contents_(std::move(contents)),
          choice_(choice),
          pairs_(std::move(pairs)),
          info_(std::move(info)) {}

    const RecordingInfo& info() const override { return info_; }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        const StampPair& pair = pairs_[index];
        if (Status status = LoadImage(*choice_.depth, pair.depth, depth); !status.ok())
            return status;
        if (choice_.colour != nullptr) return LoadImage(*choice_.colour, pair.colour, colour);
        colour.Resize(0, 0);
        return {};
    }

  private:
    template <class Pixels>
    Status LoadImage(const RosStream& stream, std::size_t index, Pixels& pixels) {
        const RosImagePlace& image = stream.images[index];
        if (Status status = files_[image.file]->Read(image.place, message_); !status.ok())
            return status;
        if (stream.is_compressed) {
            const auto message = ParseCompressedImage(stream.serialisation, message_);
            if (message) return Decode(*message, pixels);
        } else if (const auto message = ParseImage(stream.serialisation, message_)) {
            return Decode(*message, pixels);
        }
        return Status::Error(stream.topic + ": a damaged message");
    }
    template <class Message>
    static Status Decode(const Message& message, Image<std::uint16_t>& depth) {
        return DecodeRosDepth(message, depth);
    }
    template <class Message>
    static Status Decode(const Message& message, ColourImage& colour) {
        return DecodeRosColour(message, colour);
    }

    MessageFiles files_;
    const RosContents contents_;
    const RosChoice choice_;  // into contents_
    const std::vector<StampPair> pairs_;
    const RecordingInfo info_;
    std::vector<std::uint8_t> message_;
};

Status CompressedByRosbag(const std::string& path) {
    return Status::Error(
        path +
        ": compressed by rosbag2: decompress it first: ros2 bag convert -i BAG -o OUT.yaml "
        "(docs/recordings.md has the file)");
}

MessageFileResult OpenMessageFile(const std::string& path) {
    const std::string ending = EndingOf(path);
    if (IsCompressedRosFile(path)) return CompressedByRosbag(path);
    if (ending == ".bag") return OpenBagFile(path);
    return ending == ".db3" ? OpenDb3File(path) : OpenMcapFile(path);
}

// A file itself; of a folder, its files in the order of the numbers in their names.
std::vector<std::string> RosFilesAt(const std::string& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return {path};
    std::vector<std::string> names;
    for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error))
        if (const std::string ending = EndingOf(it->path().string());
            ending == ".mcap" || ending == ".db3" || IsCompressedRosFile(it->path().string()))
            names.push_back(it->path().string());
    std::ranges::sort(names, {},
                      [](const std::string& name) { return std::pair(name.size(), name); });
    return names;
}

const char* KindOf(const std::string& file) {
    return EndingOf(file) == ".bag" ? "ROS 1 bag" : "ROS 2 recording";
}

Status NoRosPairs(const std::string& path, const RosContents& contents, const RosChoice& choice) {
    if (contents.has_compressed_messages) return CompressedByRosbag(path);
    if (choice.depth == nullptr)
        return Status::Error(path +
                             ": no depth images (a topic of type sensor_msgs/Image with the "
                             "encoding 16UC1, mono16 or 32FC1, or compressedDepth)");
    const double gap_s = SmallestGap(StampsOf(*choice.depth), StampsOf(*choice.colour));
    return Status::Error(
        fmt::format("{}: no images of {} and {} belong together: the nearest "
                    "are {:.3g} s apart (see source.max_pair_gap_s)",
                    path, choice.depth->topic, choice.colour->topic, gap_s));
}

}  // namespace

bool IsCompressedRosFile(const std::string& path) {
    if (EndingOf(path) != ".zstd") return false;
    const std::string inner = EndingOf(fs::path(path).replace_extension().string());
    return inner == ".mcap" || inner == ".db3";
}

bool IsRosFolder(const std::string& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) && !RosFilesAt(path).empty();
}

RecordingResult OpenRosRecording(const std::string& path, double max_pair_gap_s,
                                 double colour_delay_s, const RosTopics& wanted) {
    const std::vector<std::string> names = RosFilesAt(path);
    MessageFiles files;
    for (const std::string& name : names) {
        MessageFileResult file = OpenMessageFile(name);
        if (!file.ok()) return file.status();
        files.push_back(std::move(file.value()));
    }
    RosContents contents = ScanRosFiles(files);
    const Result<RosChoice> chosen = ChooseRosStreams(contents, wanted);
    if (!chosen.ok()) return Status::Error(path + ": " + chosen.message());
    const RosChoice& choice = chosen.value();
    std::vector<StampPair> pairs;
    if (choice.depth != nullptr) pairs = PairsOf(choice, max_pair_gap_s, colour_delay_s);
    if (pairs.empty()) {
        std::string nothing = NoRosPairs(path, contents, choice).message();
        for (const auto* more : {&contents.notes, &contents.warnings})
            if (!more->empty()) nothing += "; " + more->front();
        return Status::Error(nothing);
    }
    RecordingInfo info;
    info.kind = KindOf(names.front());
    info.warnings = contents.warnings;
    FindRosCameras(contents, choice, info);
    const auto& depth = choice.depth->images;
    const auto& colour = choice.colour == nullptr ? depth : choice.colour->images;
    for (const StampPair& pair : pairs)
        info.pairs.push_back({depth[pair.depth].stamp_s, colour[pair.colour].stamp_s});
    if (pairs.size() < depth.size())
        info.notes.push_back(fmt::format(
            "{} of {} depth images have no colour image near enough in time and are not "
            "used (source.max_pair_gap_s)",
            depth.size() - pairs.size(), depth.size()));
    info.fps = MedianFps(info.pairs, info.fps);
    return std::unique_ptr<Recording>(std::make_unique<RosRecording>(
        std::move(files), std::move(contents), choice, std::move(pairs), std::move(info)));
}

}  // namespace tessera
