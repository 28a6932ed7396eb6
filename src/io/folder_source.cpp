#include "io/folder_source.h"

#include <algorithm>

#include "io/folder_layout.h"
#include "io/image_decoder.h"
#include "io/nominal_camera.h"
#include "io/rectifier.h"

namespace tessera {
namespace {

class FolderSource : public ListedSource {
  public:
    FolderSource(const std::string& path, FolderLayout layout, const FolderSourceConfig& config)
        : layout_(std::move(layout)),
          rectifier_(layout_.calibration, {config.rectify, layout_.invalid_depth}) {
        info_.name = path;
        info_.kind = layout_.kind;
        info_.camera = layout_.calibration.pinhole;
        info_.camera_known = layout_.camera_known;
        info_.camera_from = layout_.camera_from;
        info_.registration_known = layout_.registration_known;
        info_.one_camera = !layout_.calibration.colour;
        info_.frame_count = static_cast<std::int64_t>(layout_.frames.size());
        info_.fps = layout_.calibration.fps;
        info_.depth_units_per_m = layout_.calibration.depth_scale;
        info_.rectified = rectifier_.active();
        info_.lens_corrected = rectifier_.corrects_lens();
        info_.has_truth =
            std::any_of(layout_.frames.begin(), layout_.frames.end(),
                        [](const FolderFrame& frame) { return frame.T_world_camera.has_value(); });
        info_.notes = layout_.notes;
        info_.warnings = layout_.warnings;
        if (!config.rectify && !layout_.calibration.distortion.IsZero())
            info_.notes.push_back("lens distortion is not corrected, as configured");
    }

    ReadResult Read(Frame& frame) override {
        if (next_ >= info_.frame_count) return {ReadStatus::kEnd, {}};
        const auto index = static_cast<std::size_t>(next_++);
        const FolderFrame& listed = layout_.frames[index];
        if (Status status = Decode(listed); !status.ok())
            return {ReadStatus::kSkip, status.message()};
        frame.index = static_cast<std::int64_t>(index);
        frame.stamp_s = listed.depth_stamp_s;
        frame.colour_stamp_s = listed.colour_stamp_s;
        frame.correction = layout_.correction;
        frame.T_world_camera = listed.T_world_camera;
        rectifier_.Fill(depth_, colour_, frame);
        return {};
    }

    std::vector<double> Stamps_s() const override {
        std::vector<double> stamps_s;
        for (const FolderFrame& frame : layout_.frames) stamps_s.push_back(frame.depth_stamp_s);
        return stamps_s;
    }

    // Decodes a few frames, spread over the sequence. If none is usable, returns the first error.
    Status Probe() {
        constexpr std::size_t kProbes = 5;
        const std::size_t count = layout_.frames.size();
        Status first;
        for (std::size_t i = 0; i < std::min(kProbes, count); ++i) {
            Status status = Decode(layout_.frames[i * count / std::min(kProbes, count)]);
            if (status.ok()) return status;
            if (first.ok()) first = std::move(status);
        }
        return first;
    }

  private:
    // Decodes the frame's raw images and checks that they have the calibration's size.
    Status Decode(const FolderFrame& listed) {
        const PinholeCamera& c = info_.camera;
        if (Status status =
                Load(listed.depth_path, {c.width, c.height}, "the camera", "; correct camera.yaml");
            !status.ok())
            return status;
        if (Status status = decoder_.DecodeDepth(depth_); !status.ok()) return status;
        const bool one_camera = info_.one_camera;
        if (Status status = Load(listed.colour_path, rectifier_.colour_size(),
                                 one_camera ? "its depth image" : "the colour camera",
                                 one_camera ? "" : "; correct camera.yaml");
            !status.ok())
            return status;
        return decoder_.DecodeColour(colour_);
    }

    // Loads an image that must have `expected` pixels, as `other` has.
    Status Load(const std::string& path, const ImageSize& expected, const char* other,
                const char* advice) {
        const Result<ImageSize> size = decoder_.Load(path);
        if (!size.ok()) return size.status();
        const auto [width, height] = size.value();
        if (size.value() == expected) return Status::Ok();
        return Status::Error(fmt::format("{}: {} x {} pixels, but {} has {} x {}{}", path, width,
                                         height, other, expected.width, expected.height, advice));
    }

    FolderLayout layout_;
    Rectifier rectifier_;
    ImageDecoder decoder_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
};

}  // namespace

void FolderSourceConfig::Describe(ConfigParameters& p) {
    p.Add("max_pair_gap_s", max_pair_gap_s, {0.0, 10.0}, "s",
          "colour and depth images whose time stamps differ by this much or more are not paired; 0 "
          "is half of the time between images, at least 0.02 s and at most 0.05 s");
    p.Add(
        "rectify", rectify,
        "correct the lens distortion given in camera.yaml; turn it off only to measure its effect");
    p.Add(
        "depth_scale", depth_scale, {0.0, 1e6}, "",
        "stored depth value that corresponds to one metre; 0 takes it from the camera file; set it "
        "if depths come out too long or too short");
    p.Add(
        "colour_delay_s", colour_delay_s, {-0.1, 0.1}, "s",
        "how much later than its time stamps say a recording's colour was taken, seen from depth; "
        "calibration.check adds what it finds");
    p.Add("swap_red_blue", swap_red_blue,
          "for .klg logs: some loggers store the colour channels in the opposite order; turn it on "
          "if faces look blue");
    p.Add(
        "depth_topic", depth_topic,
        "topic of a ROS recording's depth images; empty chooses by itself; tessera info names the "
        "topics");
    p.Add("colour_topic", colour_topic,
          "topic of a ROS recording's colour images; empty chooses by itself");
}

Status FolderSourceConfig::Validate() const {
    constexpr double kLeast = 1e-3;
    if (depth_scale == 0 || depth_scale >= kLeast) return Status::Ok();
    return Status::Error(
        fmt::format("source.depth_scale: {} must be 0 or at least {}", depth_scale, kLeast));
}

CameraCalibration Configured(CameraCalibration calibration, const FolderSourceConfig& config) {
    if (config.depth_scale > 0) calibration.depth_scale = config.depth_scale;
    if (config.camera) calibration.pinhole = WithSizeOf(calibration.pinhole, *config.camera);
    constexpr double kLeast = -0.5, kMost = 0.9;  // as a camera file's
    calibration.vignetting = std::clamp(calibration.vignetting + config.vignetting, kLeast, kMost);
    MoveColour(config.colour_shift_px, calibration);
    return calibration;
}

Result<std::unique_ptr<FrameSource>> OpenFolderSource(const std::string& path,
                                                      const FolderSourceConfig& config) {
    if (Status status = config.Validate(); !status.ok()) return status;
    const bool depth_scale_set = config.depth_scale > 0;
    Result<FolderLayout> layout =
        ReadFolderLayout(path, config.max_pair_gap_s, config.colour_delay_s, depth_scale_set);
    if (!layout.ok()) return layout.status();
    if (!layout.value().camera_known)
        if (Status status = AssumeCamera(layout.value(), depth_scale_set); !status.ok())
            return status;
    layout.value().calibration = Configured(layout.value().calibration, config);
    auto source = std::make_unique<FolderSource>(path, std::move(layout.value()), config);
    if (Status status = source->Probe(); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
