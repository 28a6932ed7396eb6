#include "io/klg_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/input_file.h"
#include "io/klg_frame.h"
#include "io/klg_index.h"
#include "io/nominal_camera.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// Says in `info` where the camera is from.
Result<CameraCalibration> FindKlgCamera(const std::string& path, SourceInfo& info) {
    const fs::path file = fs::path(path).parent_path() / "camera.yaml";
    std::error_code ignored;
    constexpr double kKlgDepthScale = 1000;
    if (fs::exists(file, ignored)) {
        Result<CameraCalibration> read = ReadCameraFile(file.string());
        info.camera_from = "camera.yaml";
        if (read.ok() && !read.value().depth_scale_given) read.value().depth_scale = kKlgDepthScale;
        return read;
    }
    info.camera_known = false;
    info.camera_from = "a Kinect's focal length";
    info.notes.push_back(
        "no camera.yaml next to the log: assuming a focal length of 528 pixels; add a camera.yaml "
        "if this is a different camera");
    CameraCalibration calibration;
    calibration.pinhole = {.width = 640, .height = 480, .fx = 528, .fy = 528, .cx = 320, .cy = 240};
    calibration.depth_scale = kKlgDepthScale;
    return calibration;
}

class KlgSource : public ListedSource {
  public:
    KlgSource(InputFile file, KlgIndex index, SourceInfo info, const CameraCalibration& calibration,
              const FolderSourceConfig& config)
        : path_(file.path()),
          file_(std::move(file)),
          entries_(std::move(index.entries)),
          decoder_(calibration, {config.rectify, config.swap_red_blue}),
          correction_(StampCorrection::Of(config.colour_delay_s, true)) {
        info_ = std::move(info);
        info_.name = path_;
        info_.kind = ".klg log";
        info_.camera = calibration.pinhole;
        info_.one_camera = !calibration.colour;
        info_.frame_count = static_cast<std::int64_t>(entries_.size());
        info_.fps = calibration.fps;
        info_.depth_units_per_m = calibration.depth_scale;
        info_.rectified = decoder_.rectifies();
        info_.lens_corrected = decoder_.corrects_lens();
        info_.has_colour =
            std::ranges::any_of(entries_, [](const KlgEntry& e) { return e.colour_bytes > 0; });
        info_.warnings = std::move(index.warnings);
    }

    ReadResult Read(Frame& frame) override {
        if (next_ >= info_.frame_count) return {ReadStatus::kEnd, {}};
        const auto index = static_cast<std::size_t>(next_++);
        Status status = Load(entries_[index]);
        if (status.ok()) status = decoder_.Decode(bytes_, DepthBytes(index), frame);
        if (!status.ok())
            return {ReadStatus::kSkip,
                    fmt::format("{}: frame {}: {}", path_, index, status.message())};
        frame.index = static_cast<std::int64_t>(index);
        const double stamp_s = static_cast<double>(entries_[index].stamp_us) * 1e-6;
        frame.stamp_s = stamp_s + correction_.depth_s;
        frame.colour_stamp_s = stamp_s + correction_.colour_s;
        frame.correction = correction_;
        frame.T_world_camera.reset();
        return {};
    }

    std::vector<double> Stamps_s() const override {
        std::vector<double> stamps_s;
        for (const KlgEntry& entry : entries_)
            stamps_s.push_back(static_cast<double>(entry.stamp_us) * 1e-6 + correction_.depth_s);
        return stamps_s;
    }

    Status Probe() {
        Status status = Load(entries_.front());
        if (status.ok()) status = decoder_.Decode(bytes_, DepthBytes(0));
        return status.ok() ? status
                           : Status::Error(fmt::format("{}: frame 0: {}", path_, status.message()));
    }

  private:
    Status Load(const KlgEntry& entry) {
        bytes_.resize(std::size_t{entry.depth_bytes} + entry.colour_bytes);
        return file_.ReadAt(entry.offset, bytes_);
    }
    std::int32_t DepthBytes(std::size_t index) const {
        return static_cast<std::int32_t>(entries_[index].depth_bytes);
    }

    std::string path_;
    InputFile file_;
    std::vector<KlgEntry> entries_;
    KlgFrameDecoder decoder_;
    const StampCorrection correction_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenKlgSource(const std::string& path,
                                                   const FolderSourceConfig& config) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    SourceInfo info;
    Result<CameraCalibration> calibration = FindKlgCamera(path, info);
    if (!calibration.ok()) return calibration.status();
    if (Status status = CheckOneSize(calibration.value()); !status.ok())
        return Status::Error(path + ": its camera.yaml: " + status.message());
    calibration.value() = Configured(calibration.value(), config);
    Result<KlgIndex> index = ReadKlgIndex(file.value(), calibration.value().pinhole);
    if (!index.ok()) return index.status();
    auto source = std::make_unique<KlgSource>(std::move(file.value()), std::move(index.value()),
                                              std::move(info), calibration.value(), config);
    if (Status status = source->Probe(); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
