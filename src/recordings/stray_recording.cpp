#include "recordings/stray_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "recordings/phone_depth.h"
#include "recordings/recorded_stamps.h"
#include "recordings/stray_tables.h"
#include "recordings/stray_video.h"

namespace tessera {
namespace {

constexpr double kStrayFps = 60;  // of a video that does not say

class StrayRecording : public Recording {
  public:
    StrayRecording(const std::string& folder, RecordingInfo info, std::vector<PhoneDepth> frames,
                   StrayVideo video)
        : info_(std::move(info)),
          frames_(std::move(frames)),
          images_(folder),
          video_(std::move(video)) {}

    const RecordingInfo& info() const override { return info_; }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        TESSERA_CHECK(index < frames_.size(), "frame {} of {}", index, frames_.size());
        const PhoneDepth& frame = frames_[index];
        if (Status status = images_.ReadDepth(frame, depth); !status.ok()) return status;
        return video_.Read(frame.number, colour);
    }

  private:
    RecordingInfo info_;
    std::vector<PhoneDepth> frames_;
    PhoneImages images_;
    StrayVideo video_;
};

void SetStrayStamps(const std::string& folder, const StrayVideo& video,
                    const std::vector<PhoneDepth>& frames, RecordingInfo& info) {
    const std::vector<StrayStamp> stamps = ReadStrayStamps(folder + "/odometry.csv");
    for (const PhoneDepth& frame : frames) {
        const auto found = std::ranges::lower_bound(stamps, frame.number, {}, &StrayStamp::frame);
        if (found != stamps.end() && found->frame == frame.number)
            info.pairs.push_back({found->stamp_s, found->stamp_s});
    }
    if (info.pairs.size() == frames.size() && DepthStampsIncrease(info.pairs)) {
        info.fps = MedianFps(info.pairs, video.fps() > 0 ? video.fps() : kStrayFps);
        return;
    }
    info.fps = video.fps() > 0 ? video.fps() : kStrayFps;
    std::error_code ignored;
    const bool there = std::filesystem::exists(folder + "/odometry.csv", ignored);
    info.notes.push_back(fmt::format(
        "odometry.csv {}; {:g} frames per second are assumed",
        there ? "has no increasing time stamp for each depth image" : "is missing", info.fps));
    info.pairs.clear();
    for (const PhoneDepth& frame : frames) {
        const double stamp_s = static_cast<double>(frame.number) / info.fps;
        info.pairs.push_back({stamp_s, stamp_s});
    }
}

Status SetStrayCameras(const std::string& folder, const StrayVideo& video, ImageSize depth,
                       RecordingInfo& info) {
    const Result<PinholeCamera> colour =
        ReadStrayCamera(folder + "/camera_matrix.csv", video.width(), video.height());
    if (!colour.ok()) return colour.status();
    const Status status = SetPhoneCameras(colour.value(), depth, info);
    return status.ok() ? status : Status::Error(folder + ": " + status.message());
}

}  // namespace

bool IsStrayFolder(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    return fs::is_regular_file(path + "/rgb.mp4", ignored) &&
           fs::is_regular_file(path + "/camera_matrix.csv", ignored) &&
           fs::is_directory(path + "/depth", ignored);
}

RecordingResult OpenStrayRecording(const std::string& path) {
    RecordingInfo info;
    info.kind = "Stray Scanner folder";
    std::vector<PhoneDepth> frames = FindPhoneDepth(path, "depth", "confidence", info);
    if (frames.empty())
        return Status::Error(path +
                             "/depth: has no depth images 000000.png, 000001.png, ...; copy the "
                             "whole folder, of a recording by a recent version of the app");
    Result<StrayVideo> video = StrayVideo::Open(path + "/rgb.mp4");
    if (!video.ok()) return video.status();
    std::vector<std::string> names;
    for (const PhoneDepth& frame : frames) names.push_back(frame.depth);
    const Result<ImageSize> size = PhoneImages(path).FirstSize(names);
    if (!size.ok()) return Status::Error(path + "/" + size.message());
    if (Status status = SetStrayCameras(path, video.value(), size.value(), info); !status.ok())
        return status;
    SetStrayStamps(path, video.value(), frames, info);
    info.depth_camera.fps = info.colour_camera.fps = info.fps;
    const std::int64_t count = video.value().frame_count();
    if (count > 0 && frames.back().number >= static_cast<std::uint64_t>(count))
        info.warnings.push_back(
            fmt::format("the video has {} frames, but depth images are numbered up to {}; colour "
                        "may be missing or of another moment",
                        count, frames.back().number));
    return std::unique_ptr<Recording>(std::make_unique<StrayRecording>(
        path, std::move(info), std::move(frames), std::move(video.value())));
}

}  // namespace tessera
