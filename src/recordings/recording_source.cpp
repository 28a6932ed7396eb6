#include "recordings/recording_source.h"

#include <fmt/format.h>

#include "io/nominal_camera.h"
#include "io/rectifier.h"
#include "io/stamp_pairing.h"
#include "recordings/phone_depth.h"

namespace tessera {
namespace {

// The calibration of the depth images, with the colour camera where it is another one.
CameraCalibration CalibrationOf(const RecordingInfo& info) {
    CameraCalibration calibration = info.depth_camera;
    if (!IsRegistered(info))
        calibration.colour = ColourCamera{info.colour_camera.pinhole, info.colour_camera.distortion,
                                          info.T_colour_depth};
    return calibration;
}

// Colour is registered to depth, so that what is found out about one lens holds for both.
bool HasOneCamera(const RecordingInfo& info) {
    constexpr double kSame_px = 0.5;
    const PinholeCamera& colour = info.colour_camera.pinhole;
    const PinholeCamera depth = ScaledTo(info.depth_camera.pinhole, colour.width, colour.height);
    return info.T_colour_depth.matrix().isIdentity(1e-9) &&
           Eigen::Vector4d(colour.fx - depth.fx, colour.fy - depth.fy, colour.cx - depth.cx,
                           colour.cy - depth.cy)
                   .cwiseAbs()
                   .maxCoeff() <= kSame_px;
}

// `who` gives the depth unit, which counts unless the format itself has metres.
void UseDepthScale(double depth_scale, const std::string& who, RecordingInfo& info) {
    if (info.depth_in_m)
        info.notes.push_back("depth is recorded in metres: " + who + " is not applied");
    else
        info.depth_camera.depth_scale = depth_scale;
}

// The recording's cameras with what the configuration says.
RecordingInfo Configured(RecordingInfo info, const FolderSourceConfig& config) {
    if (config.depth_scale > 0) UseDepthScale(config.depth_scale, "source.depth_scale", info);
    if (config.camera) {
        const bool one_camera = HasOneCamera(info);
        info.depth_camera.pinhole = WithSizeOf(info.depth_camera.pinhole, *config.camera);
        const PinholeCamera& colour = info.colour_camera.pinhole;
        if (one_camera)
            info.colour_camera.pinhole =
                ScaledTo(info.depth_camera.pinhole, colour.width, colour.height);
    }
    if (!config.rectify) info.depth_camera.distortion = info.colour_camera.distortion = {};
    return info;
}

// Takes the cameras from a camera file: that of the depth images, with colour registered to it
// unless the file has a colour camera.
Status TakeCamera(const std::string& file, RecordingInfo& info) {
    const Result<CameraCalibration> read = ReadCameraFile(file);
    if (!read.ok()) return read.status();
    const CameraCalibration& camera = read.value();
    const PinholeCamera depth = info.depth_camera.pinhole, colour = info.colour_camera.pinhole;
    if (camera.pinhole.width != depth.width || camera.pinhole.height != depth.height)
        return Status::Error(fmt::format("{}: is for images of {} x {}, but depth has {} x {}",
                                         file, camera.pinhole.width, camera.pinhole.height,
                                         depth.width, depth.height));
    const double depth_scale = info.depth_camera.depth_scale;
    info.depth_camera = info.colour_camera = camera;
    info.depth_camera.depth_scale = depth_scale;
    info.depth_camera.colour = info.colour_camera.colour = std::nullopt;
    info.T_colour_depth = Eigen::Isometry3d::Identity();
    if (camera.colour) {
        info.colour_camera.pinhole = camera.colour->pinhole;
        info.colour_camera.distortion = camera.colour->distortion;
        info.T_colour_depth = camera.colour->T_colour_depth;
    } else {
        info.colour_camera.pinhole = ScaledTo(camera.pinhole, colour.width, colour.height);
    }
    info.camera_known = true;
    info.camera_from = "camera.yaml";
    std::erase_if(info.notes, [](const std::string& note) {
        return note.find(kNoCameraInfo) != std::string::npos;
    });
    info.notes.push_back("the camera is that of " + file);
    if (camera.depth_scale_given) UseDepthScale(camera.depth_scale, "its depth_scale", info);
    return {};
}

class RecordingSource : public ListedSource {
  public:
    RecordingSource(const std::string& path, std::unique_ptr<Recording> recording,
                    RecordingInfo info, const CameraCalibration& calibration, double colour_delay_s)
        : recording_(std::move(recording)),
          recorded_(std::move(info)),
          rectifier_(calibration, {}),
          correction_(StampCorrection::Of(colour_delay_s, ShareStamps(recorded_.pairs))) {
        info_.name = path;
        info_.kind = recorded_.kind;
        info_.camera = recorded_.depth_camera.pinhole;
        info_.camera_known = recorded_.camera_known;
        info_.camera_from = recorded_.camera_from;
        info_.one_camera = HasOneCamera(recorded_);
        info_.frame_count = std::ssize(recorded_.pairs);
        info_.fps = recorded_.fps;
        info_.depth_units_per_m = recorded_.depth_camera.depth_scale;
        info_.rectified = rectifier_.active();
        info_.lens_corrected = rectifier_.corrects_lens();
        info_.has_colour = recorded_.has_colour;
        info_.notes = recorded_.notes;
        info_.warnings = recorded_.warnings;
    }

    ReadResult Read(Frame& frame) override {
        if (next_ >= info_.frame_count) return {ReadStatus::kEnd, {}};
        const std::int64_t index = next_++;
        if (Status status = Load(index); !status.ok())
            return {ReadStatus::kSkip,
                    fmt::format("{}: frame {}: {}", info_.name, index, status.message())};
        rectifier_.Fill(depth_, colour_, frame);
        const RecordedPair& pair = recorded_.pairs[static_cast<std::size_t>(index)];
        frame.index = index;
        frame.stamp_s = pair.depth_stamp_s + correction_.depth_s;
        frame.colour_stamp_s = pair.colour_stamp_s + correction_.colour_s;
        frame.correction = correction_;
        frame.T_world_camera.reset();
        return {};
    }

    std::vector<double> Stamps_s() const override {
        std::vector<double> stamps_s;
        for (const RecordedPair& pair : recorded_.pairs)
            stamps_s.push_back(pair.depth_stamp_s + correction_.depth_s);
        return stamps_s;
    }

    // The first pairs decide: if none can be loaded, the whole recording is not what it seems.
    Status Probe() {
        constexpr std::int64_t kTried = 5;
        Status first;
        for (std::int64_t i = 0; i < std::min(kTried, info_.frame_count); ++i) {
            Status status = Load(i);
            if (status.ok()) return status;
            if (first.ok()) first = std::move(status);
        }
        return Status::Error(
            fmt::format("{}: {}", info_.name,
                        first.ok() ? "no pair of depth and colour images" : first.message()));
    }

  private:
    Status Load(std::int64_t index) {
        Status status = recording_->Load(static_cast<std::size_t>(index), depth_, colour_);
        if (!status.ok()) return status;
        if (Status size =
                SizeIs("depth", depth_.width(), depth_.height(), recorded_.depth_camera.pinhole);
            !size.ok())
            return size;
        if (colour_.empty()) return {};
        return SizeIs("colour", colour_.width(), colour_.height(), recorded_.colour_camera.pinhole);
    }
    static Status SizeIs(const char* which, int width, int height, const PinholeCamera& camera) {
        if (width == camera.width && height == camera.height) return {};
        return Status::Error(fmt::format("{} has {} x {} pixels, but its camera has {} x {}", which,
                                         width, height, camera.width, camera.height));
    }

    std::unique_ptr<Recording> recording_;
    const RecordingInfo recorded_;
    Rectifier rectifier_;
    const StampCorrection correction_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> MakeRecordingSource(const std::string& path,
                                                         std::unique_ptr<Recording> recording,
                                                         const FolderSourceConfig& config,
                                                         const std::string& camera_file) {
    if (Status status = config.Validate(); !status.ok()) return status;
    RecordingInfo info = recording->info();
    if (!info.camera_known && !camera_file.empty())
        if (Status status = TakeCamera(camera_file, info); !status.ok()) return status;
    info = Configured(std::move(info), config);
    for (const CameraCalibration* camera : {&info.depth_camera, &info.colour_camera})
        if (Status status = CheckPlausible(camera->pinhole); !status.ok())
            return Status::Error(path + ": its calibration: " + status.message());
    CameraCalibration calibration = CalibrationOf(info);
    FolderSourceConfig colour;  // the rest is in `info` already
    colour.vignetting = config.vignetting;
    colour.colour_shift_px = config.colour_shift_px;
    calibration = Configured(calibration, colour);
    auto source = std::make_unique<RecordingSource>(path, std::move(recording), std::move(info),
                                                    calibration, config.colour_delay_s);
    if (Status status = source->Probe(); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
