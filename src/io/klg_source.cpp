#include "io/klg_source.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/input_file.h"
#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"
#include "io/klg_index.h"
#include "io/nominal_camera.h"
#include "io/rectifier.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

Result<CameraCalibration> FindKlgCamera(const std::string& path, std::vector<std::string>& notes) {
    const fs::path file = fs::path(path).parent_path() / "camera.yaml";
    std::error_code ignored;
    constexpr double kMillimetres = 1000;  // the unit of .klg logs
    if (fs::exists(file, ignored)) {
        Result<CameraCalibration> read = ReadCameraFile(file.string());
        if (read.ok() && !read.value().depth_scale_given) read.value().depth_scale = kMillimetres;
        return read;
    }
    notes.push_back(
        "no camera.yaml next to the log: assuming a focal length of 528 pixels; add a camera.yaml "
        "if this is a different camera");
    CameraCalibration calibration;
    calibration.pinhole = {.width = 640, .height = 480, .fx = 528, .fy = 528, .cx = 320, .cy = 240};
    calibration.depth_scale = kMillimetres;
    return calibration;
}

class KlgSource : public FrameSource {
  public:
    KlgSource(InputFile file, KlgIndex index, std::vector<std::string> notes,
              const CameraCalibration& calibration, const FolderSourceConfig& config)
        : path_(file.path()),
          file_(std::move(file)),
          entries_(std::move(index.entries)),
          swap_red_blue_(config.swap_red_blue),
          rectifier_(calibration, {.correct_distortion = config.rectify}) {
        info_.name = path_;
        info_.kind = ".klg log";
        info_.camera = calibration.pinhole;
        info_.frame_count = static_cast<std::int64_t>(entries_.size());
        info_.fps = calibration.fps;
        info_.depth_units_per_m = calibration.depth_scale;
        info_.rectified = rectifier_.active();
        info_.notes = std::move(notes);
        info_.warnings = std::move(index.warnings);
    }

    const SourceInfo& info() const override { return info_; }

    ReadResult Read(Frame& frame) override {
        if (next_ >= entries_.size()) return {ReadStatus::kEnd, {}};
        const std::size_t index = next_++;
        if (Status status = Decode(entries_[index]); !status.ok())
            return {ReadStatus::kSkip,
                    fmt::format("{}: frame {}: {}", path_, index, status.message())};
        frame.index = static_cast<std::int64_t>(index);
        frame.stamp_s = frame.colour_stamp_s = static_cast<double>(entries_[index].stamp_us) * 1e-6;
        frame.T_world_camera.reset();
        rectifier_.Fill(depth_, colour_, frame);
        return {};
    }

    bool Seek(std::int64_t index) override {
        if (index < 0 || index > info_.frame_count) return false;
        next_ = static_cast<std::size_t>(index);
        return true;
    }

    Status Probe() {
        Status status = Decode(entries_.front());
        return status.ok() ? status
                           : Status::Error(fmt::format("{}: frame 0: {}", path_, status.message()));
    }

  private:
    Status Decode(const KlgEntry& entry) {
        bytes_.resize(std::size_t{entry.depth_bytes} + entry.colour_bytes);
        if (Status status = file_.ReadAt(entry.offset, bytes_); !status.ok()) return status;
        const std::span<const std::uint8_t> all(bytes_);
        if (Status status = DecodeDepth(all.first(entry.depth_bytes)); !status.ok()) return status;
        return DecodeColour(all.subspan(entry.depth_bytes));
    }

    Status DecodeDepth(std::span<const std::uint8_t> bytes) {
        depth_.Resize(info_.camera.width, info_.camera.height);
        const std::size_t size = depth_.size() * sizeof(std::uint16_t);
        if (bytes.size() == size) {
            std::memcpy(depth_.data(), bytes.data(), size);
            return Status::Ok();
        }
        if (libdeflate_zlib_decompress(inflater_.get(), bytes.data(), bytes.size(), depth_.data(),
                                       size, nullptr) != LIBDEFLATE_SUCCESS)
            return Status::Error(
                fmt::format("depth is damaged, or its size is not {} x {} pixels (set the size in "
                            "camera.yaml next to the log)",
                            info_.camera.width, info_.camera.height));
        return Status::Ok();
    }

    Status DecodeColour(std::span<const std::uint8_t> bytes) {
        colour_.Resize(bytes.empty() ? 0 : info_.camera.width,
                       bytes.empty() ? 0 : info_.camera.height);
        if (bytes.size() == colour_.size() * sizeof(Rgb8)) {
            if (!bytes.empty()) std::memcpy(colour_.data(), bytes.data(), bytes.size());
        } else if (Status status = DecodeCompressed(bytes); !status.ok()) {
            return Status::Error("colour " + status.message());
        }
        if (swap_red_blue_)
            std::for_each_n(colour_.data(), colour_.size(), [](Rgb8& c) { std::swap(c.r, c.b); });
        return Status::Ok();
    }

    Status DecodeCompressed(std::span<const std::uint8_t> bytes) {
        const PinholeCamera& c = info_.camera;
        const auto size = ReadJpegSize(bytes);
        if (size && *size != ImageSize{c.width, c.height})
            return Status::Error(
                fmt::format("has {} x {} pixels, but the camera has {} x {}; correct camera.yaml "
                            "next to the log",
                            size->width, size->height, c.width, c.height));
        return DecodeJpeg(bytes, ImageDecoder::kMaxSide_px, colour_);
    }

    struct FreeInflater {
        void operator()(libdeflate_decompressor* inflater) const {
            libdeflate_free_decompressor(inflater);
        }
    };

    std::string path_;
    InputFile file_;
    std::vector<KlgEntry> entries_;
    bool swap_red_blue_;
    Rectifier rectifier_;
    SourceInfo info_;
    std::unique_ptr<libdeflate_decompressor, FreeInflater> inflater_{
        libdeflate_alloc_decompressor()};
    std::vector<std::uint8_t> bytes_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
    std::size_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenKlgSource(const std::string& path,
                                                   const FolderSourceConfig& config) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    std::vector<std::string> notes;
    Result<CameraCalibration> calibration = FindKlgCamera(path, notes);
    if (!calibration.ok()) return calibration.status();
    if (config.depth_scale > 0) calibration.value().depth_scale = config.depth_scale;
    if (config.camera)
        calibration.value().pinhole = WithSizeOf(calibration.value().pinhole, *config.camera);
    Result<KlgIndex> index = ReadKlgIndex(file.value(), calibration.value().pinhole);
    if (!index.ok()) return index.status();
    auto source = std::make_unique<KlgSource>(std::move(file.value()), std::move(index.value()),
                                              std::move(notes), calibration.value(), config);
    if (Status status = source->Probe(); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
