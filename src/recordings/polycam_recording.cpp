#include "recordings/polycam_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/input_file.h"
#include "recordings/phone_depth.h"
#include "recordings/recorded_stamps.h"

namespace tessera {
namespace {

constexpr double kPolycamFps = 2;  // of keyframes without time stamps

struct PolycamFrame {
    PhoneDepth depth;           // its number: microseconds
    std::string image, camera;  // files
};

class PolycamRecording : public Recording {
  public:
    PolycamRecording(const std::string& folder, RecordingInfo info,
                     std::vector<PolycamFrame> frames)
        : info_(std::move(info)), frames_(std::move(frames)), images_(folder) {}

    const RecordingInfo& info() const override { return info_; }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        TESSERA_CHECK(index < frames_.size(), "frame {} of {}", index, frames_.size());
        const PolycamFrame& frame = frames_[index];
        if (Status status = images_.ReadDepth(frame.depth, depth); !status.ok()) return status;
        return images_.ReadColour(frame.image, colour);
    }

  private:
    RecordingInfo info_;
    std::vector<PolycamFrame> frames_;
    PhoneImages images_;
};

std::optional<double> PolycamNumber(const nlohmann::json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
}

Result<PinholeCamera> ReadPolycamCamera(const std::string& path) {
    constexpr std::size_t kMostBytes = 1 << 20;
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    if (!text.ok()) return text.status();
    const auto json = nlohmann::json::parse(text.value(), nullptr, false);
    if (!json.is_object()) return Status::Error(path + ": is no JSON object; export it again");
    double values[6];
    constexpr const char* kKeys[6] = {"width", "height", "fx", "fy", "cx", "cy"};
    for (std::size_t i = 0; i < std::size(values); ++i) {
        const std::optional<double> value = PolycamNumber(json, kKeys[i]);
        if (!value) return Status::Error(fmt::format("{}: has no number {}", path, kKeys[i]));
        values[i] = *value;
    }
    constexpr double kMost_px = ImageDecoder::kMaxSide_px;
    for (const double side : {values[0], values[1]})
        if (!(side >= 1 && side <= kMost_px))
            return Status::Error(
                fmt::format("{}: an image side of {} is not plausible", path, side));
    const PinholeCamera camera{.width = static_cast<int>(values[0]),
                               .height = static_cast<int>(values[1]),
                               .fx = values[2],
                               .fy = values[3],
                               .cx = values[4],
                               .cy = values[5]};
    if (Status status = CheckPlausible(camera); !status.ok())
        return Status::Error(path + ": " + status.message());
    return camera;
}

// Those of one kind, as recorded or corrected.
struct PolycamFiles {
    PolycamFiles(const std::string& path, std::string subfolder_name, const char* extension)
        : subfolder(std::move(subfolder_name)),
          files(NumberedFiles(path + "/" + subfolder, extension)) {}
    std::string subfolder;
    std::vector<NumberedFile> files;
};

// The keyframes that have depth, image and camera.
std::vector<PolycamFrame> FindPolycamFrames(const std::string& path, RecordingInfo& info) {
    PolycamFiles images(path, "keyframes/images", "jpg");
    PolycamFiles cameras(path, "keyframes/cameras", "json");
    const bool corrected = images.files.empty();
    if (corrected) images = PolycamFiles(path, "keyframes/corrected_images", "jpg");
    if (PolycamFiles other(path, "keyframes/corrected_cameras", "json");
        cameras.files.empty() || (corrected && !other.files.empty()))
        cameras = std::move(other);
    const std::vector<PhoneDepth> depth =
        FindPhoneDepth(path, "keyframes/depth", "keyframes/confidence", info);
    std::vector<PolycamFrame> frames;
    for (const PhoneDepth& names : depth) {
        PolycamFrame frame{names, NameOfNumber(images.subfolder, images.files, names.number),
                           NameOfNumber(cameras.subfolder, cameras.files, names.number)};
        if (!frame.image.empty() && !frame.camera.empty()) frames.push_back(std::move(frame));
    }
    if (frames.size() < depth.size())
        info.warnings.push_back(
            fmt::format("{} of {} depth images are left out: they have no image or no camera",
                        depth.size() - frames.size(), depth.size()));
    if (corrected && !frames.empty())
        info.warnings.push_back(
            "there are only corrected images: the lens's distortion was taken from colour, but not "
            "from depth");
    return frames;
}

bool SamePolycamCamera(const PinholeCamera& a, const PinholeCamera& b) {
    constexpr double kMost = 0.01;
    return a.width == b.width && a.height == b.height && std::abs(a.fx - b.fx) <= kMost * a.fx &&
           std::abs(a.fy - b.fy) <= kMost * a.fy && std::abs(a.cx - b.cx) <= kMost * a.width &&
           std::abs(a.cy - b.cy) <= kMost * a.height;
}

// The first camera that can be read, which all keyframes get.
Result<PinholeCamera> FirstPolycamCamera(const std::string& path,
                                         const std::vector<PolycamFrame>& frames,
                                         RecordingInfo& info) {
    std::optional<PinholeCamera> first;
    Status error;
    std::size_t damaged = 0, others = 0;
    for (const PolycamFrame& frame : frames) {
        const Result<PinholeCamera> camera = ReadPolycamCamera(path + "/" + frame.camera);
        if (!camera.ok()) {
            if (damaged++ == 0) error = camera.status();
        } else if (!first) {
            first = camera.value();
        } else if (!SamePolycamCamera(*first, camera.value())) {
            ++others;
        }
    }
    if (!first) return error;
    if (damaged > 0)
        info.warnings.push_back(fmt::format("{} of {} cameras cannot be read (the first: {})",
                                            damaged, frames.size(), error.message()));
    if (others > 0)
        info.warnings.push_back(fmt::format(
            "{} of {} cameras differ by more than 1 % from the first one, which is used for all",
            others, frames.size()));
    return *first;
}

void SetPolycamStamps(const std::vector<PolycamFrame>& frames, RecordingInfo& info) {
    for (const PolycamFrame& frame : frames) {
        const double stamp_s = static_cast<double>(frame.depth.number) * 1e-6;
        info.pairs.push_back({stamp_s, stamp_s});
    }
    constexpr double kMostFps = 1000;
    info.fps = MedianFps(info.pairs, kPolycamFps);
    if (info.fps > kMostFps || !DepthStampsIncrease(info.pairs)) {
        info.notes.push_back(
            fmt::format("the keyframes are numbered instead of named by their time; {} per second "
                        "are assumed",
                        kPolycamFps));
        info.pairs = EvenlyStamped(frames.size(), kPolycamFps);
        info.fps = kPolycamFps;
    }
    constexpr double kLeastFps = 8;
    if (info.fps < kLeastFps)
        info.warnings.push_back(fmt::format(
            "keyframes are {:.2f} s apart; where the camera moved fast between them, tracking may "
            "lose it",
            1 / info.fps));
}

}  // namespace

bool IsPolycamFolder(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    return fs::is_directory(path + "/keyframes/depth", ignored) &&
           (fs::is_directory(path + "/keyframes/cameras", ignored) ||
            fs::is_directory(path + "/keyframes/corrected_cameras", ignored));
}

RecordingResult OpenPolycamRecording(const std::string& path) {
    RecordingInfo info;
    info.kind = "Polycam folder";
    std::vector<PolycamFrame> frames = FindPolycamFrames(path, info);
    if (frames.empty())
        return Status::Error(path +
                             "/keyframes: has no keyframe with depth, image and camera; "
                             "export the raw data again");
    const Result<PinholeCamera> camera = FirstPolycamCamera(path, frames, info);
    if (!camera.ok()) return camera.status();
    std::vector<std::string> names;
    for (const PolycamFrame& frame : frames) names.push_back(frame.depth.depth);
    const Result<ImageSize> size = PhoneImages(path).FirstSize(names);
    if (!size.ok()) return Status::Error(path + "/" + size.message());
    if (Status status = SetPhoneCameras(camera.value(), size.value(), info); !status.ok())
        return Status::Error(path + ": " + status.message());
    SetPolycamStamps(frames, info);
    info.depth_camera.fps = info.colour_camera.fps = info.fps;
    return std::unique_ptr<Recording>(
        std::make_unique<PolycamRecording>(path, std::move(info), std::move(frames)));
}

}  // namespace tessera
