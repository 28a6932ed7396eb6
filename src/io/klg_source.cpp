#include "io/klg_source.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"
#include "io/nominal_camera.h"
#include "io/rectifier.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

struct Entry {
    std::int64_t stamp_us = 0;
    std::uint64_t offset = 0;  // of the depth data; colour follows
    std::uint32_t depth_bytes = 0, colour_bytes = 0;
};

struct Index {
    std::vector<Entry> entries;
    std::vector<std::string> notes;
};

template <typename Number>
bool ReadNumber(std::istream& file, Number& number) {
    return static_cast<bool>(file.read(reinterpret_cast<char*>(&number), sizeof(number)));
}

// Walks from header to header. Allocates only for frames that are present, not for the number the
// file claims.
Result<Index> ReadIndex(const std::string& path, std::istream& file, std::uint64_t file_bytes) {
    constexpr std::uint64_t kHeader = 16;
    std::int32_t count = 0;
    if (!ReadNumber(file, count) || count < 0)
        return Status::Error(path + ": is not a .klg log: it does not start with a frame count");
    Index index;
    std::uint64_t at = sizeof(count);
    std::int32_t whole = 0;
    for (; whole < count && at + kHeader <= file_bytes; ++whole) {
        Entry entry;
        std::int32_t depth_bytes = 0, colour_bytes = 0;
        file.seekg(static_cast<std::streamoff>(at));
        if (!ReadNumber(file, entry.stamp_us) || !ReadNumber(file, depth_bytes) ||
            !ReadNumber(file, colour_bytes))
            break;
        if (depth_bytes <= 0 || colour_bytes < 0)
            return Status::Error(
                fmt::format("{}: frame {} has {} bytes of depth and {} of colour; this is not a "
                            ".klg log, or it is damaged",
                            path, whole, depth_bytes, colour_bytes));
        entry.offset = at + kHeader;
        entry.depth_bytes = static_cast<std::uint32_t>(depth_bytes);
        entry.colour_bytes = static_cast<std::uint32_t>(colour_bytes);
        at = entry.offset + entry.depth_bytes + entry.colour_bytes;
        if (at > file_bytes) break;
        if (index.entries.empty() || entry.stamp_us > index.entries.back().stamp_us)
            index.entries.push_back(entry);
    }
    if (whole < count)
        index.notes.push_back(
            fmt::format("the log is truncated: {} of its {} frames are present", whole, count));
    if (const auto dropped = static_cast<std::size_t>(whole) - index.entries.size(); dropped > 0)
        index.notes.push_back(fmt::format(
            "{} of {} frames are dropped: their time stamps do not increase", dropped, whole));
    if (index.entries.empty()) return Status::Error(path + ": contains no complete frame");
    return index;
}

Result<CameraCalibration> FindKlgCamera(const std::string& path, std::vector<std::string>& notes) {
    const fs::path file = fs::path(path).parent_path() / "camera.yaml";
    std::error_code ignored;
    if (fs::exists(file, ignored)) return ReadCameraFile(file.string());
    notes.push_back(
        "no camera.yaml next to the log: assuming a focal length of 528 pixels; add a camera.yaml "
        "if this is a different camera");
    CameraCalibration calibration;
    calibration.pinhole = {.width = 640, .height = 480, .fx = 528, .fy = 528, .cx = 320, .cy = 240};
    calibration.depth_scale = 1000;
    return calibration;
}

class KlgSource : public FrameSource {
  public:
    KlgSource(const std::string& path, std::ifstream file, Index index,
              const CameraCalibration& calibration, const FolderSourceConfig& config)
        : path_(path),
          file_(std::move(file)),
          entries_(std::move(index.entries)),
          swap_red_blue_(config.swap_red_blue),
          rectifier_(calibration, {.correct_distortion = config.rectify}) {
        info_.name = path;
        info_.kind = ".klg log";
        info_.camera = calibration.pinhole;
        info_.frame_count = static_cast<std::int64_t>(entries_.size());
        info_.fps = calibration.fps;
        info_.depth_units_per_m = calibration.depth_scale;
        info_.rectified = rectifier_.active();
        info_.notes = std::move(index.notes);
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
    Status Decode(const Entry& entry) {
        bytes_.resize(std::size_t{entry.depth_bytes} + entry.colour_bytes);
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(entry.offset));
        if (!file_.read(reinterpret_cast<char*>(bytes_.data()),
                        static_cast<std::streamsize>(bytes_.size())))
            return Status::Error("cannot be read");
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
        } else if (Status status = DecodeJpeg(bytes, ImageDecoder::kMaxSide_px, colour_);
                   !status.ok()) {
            return Status::Error("colour " + status.message());
        }
        if (colour_.size() > 0 &&
            (colour_.width() != info_.camera.width || colour_.height() != info_.camera.height))
            return Status::Error(fmt::format(
                "colour has {} x {} pixels, but the camera has {} x {}; correct camera.yaml next "
                "to "
                "the log",
                colour_.width(), colour_.height(), info_.camera.width, info_.camera.height));
        if (swap_red_blue_)
            std::for_each_n(colour_.data(), colour_.size(), [](Rgb8& c) { std::swap(c.r, c.b); });
        return Status::Ok();
    }

    struct FreeInflater {
        void operator()(libdeflate_decompressor* inflater) const {
            libdeflate_free_decompressor(inflater);
        }
    };

    std::string path_;
    std::ifstream file_;
    std::vector<Entry> entries_;
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
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return Status::Error(path + ": no such file");
    const std::uint64_t file_bytes = fs::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    if (error || !file) return Status::Error(path + ": cannot be read");
    Result<Index> index = ReadIndex(path, file, file_bytes);
    if (!index.ok()) return index.status();
    Result<CameraCalibration> calibration = FindKlgCamera(path, index.value().notes);
    if (!calibration.ok()) return calibration.status();
    if (config.depth_scale > 0) calibration.value().depth_scale = config.depth_scale;
    if (config.camera)
        calibration.value().pinhole = WithSizeOf(calibration.value().pinhole, *config.camera);
    auto source = std::make_unique<KlgSource>(path, std::move(file), std::move(index.value()),
                                              calibration.value(), config);
    if (Status status = source->Probe(); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
