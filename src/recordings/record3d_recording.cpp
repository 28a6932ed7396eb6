#include "recordings/record3d_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "io/jpeg_decoder.h"
#include "recordings/lzfse.h"
#include "recordings/phone_depth.h"
#include "recordings/record3d_frames.h"
#include "recordings/record3d_metadata.h"
#include "recordings/recorded_stamps.h"

namespace tessera {
namespace {

constexpr std::size_t kR3dMostBytes = std::size_t{64} << 20;  // of a file in the archive
constexpr int kR3dMostSide_px = 8192;
constexpr double kR3dUnitsPerMetre = 10000;
constexpr float kR3dFarthest_m = 6.5f;  // 16 bits end at 6.55 m
constexpr double kR3dUsualFps = 30;

// 0 without a measurement, also for NaN.
std::uint16_t StoredR3dDepth(float depth_m) {
    if (!(depth_m > 0 && depth_m <= kR3dFarthest_m)) return 0;
    return static_cast<std::uint16_t>(std::lround(depth_m * kR3dUnitsPerMetre));
}

std::string R3dSizeText(const PinholeCamera& camera) {
    return fmt::format("{} x {} pixels", camera.width, camera.height);
}

class Record3dRecording : public Recording {
  public:
    explicit Record3dRecording(ZipFile archive) : archive_(std::move(archive)) {}

    const RecordingInfo& info() const override { return info_; }

    // Errors do not name the recording.
    Status Start() {
        const Result<Record3dMetadata> metadata = ReadMetadata();
        if (!metadata.ok()) return metadata.status();
        const Record3dFrames frames = FindRecord3dFrames(archive_);
        for (const auto& [number, frame] : frames)
            if (frame.whole()) frames_.push_back(frame);
        if (frames_.empty())
            return Status::Error("has no frame with both rgbd/N.jpg and rgbd/N.depth");
        info_.kind = "Record3D recording";
        if (const std::size_t missing = frames.size() - frames_.size(); missing > 0)
            info_.warnings.push_back(
                fmt::format("{} of {} frames are left out: their image or their depth is missing",
                            missing, frames.size()));
        SetStamps(metadata.value(), frames);
        return SetCameras(metadata.value());
    }

    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        TESSERA_CHECK(index < frames_.size(), "frame {} of {}", index, frames_.size());
        try {
            Status status = LoadDepth(frames_[index], depth);
            return status.ok() ? LoadColour(frames_[index], colour) : status;
        } catch (const std::bad_alloc&) {
            return Status::Error("does not fit in memory");
        }
    }

  private:
    Result<Record3dMetadata> ReadMetadata() {
        std::size_t index = 0;
        while (index < archive_.count() && archive_.Name(index) != "metadata") ++index;
        if (index == archive_.count())
            return Status::Error("is no Record3D recording, it has no file 'metadata'");
        Status status = archive_.Read(index, kR3dMostBytes, bytes_);
        if (!status.ok()) return Status::Error("metadata " + status.message());
        Result<Record3dMetadata> metadata =
            ParseRecord3dMetadata({reinterpret_cast<const char*>(bytes_.data()), bytes_.size()});
        return metadata.ok() ? metadata : Status::Error("metadata " + metadata.message());
    }

    void SetStamps(const Record3dMetadata& metadata, const Record3dFrames& frames) {
        const double fps = metadata.fps > 0 ? metadata.fps : kR3dUsualFps;
        info_.pairs = StampedRecord3dPairs(frames, metadata.stamps_s);
        if (info_.pairs.empty()) {
            info_.pairs = EvenRecord3dPairs(frames, fps);
            const std::string assumed = fmt::format("{} frames per second are assumed", fps);
            if (metadata.stamps_s.empty())
                info_.notes.push_back("it has no time stamps: " + assumed);
            else
                info_.warnings.push_back("its time stamps do not fit its frames: " + assumed);
        }
        info_.fps = MedianFps(info_.pairs, fps);
    }

    // The first frame that is not damaged tells the sizes of images.
    Status SetCameras(const Record3dMetadata& metadata) {
        constexpr std::size_t kTried = 5;
        Status status;
        for (std::size_t i = 0; i < std::min(kTried, frames_.size()); ++i) {
            status = SetCamerasFrom(metadata, frames_[i]);
            if (status.ok()) break;
        }
        return status;
    }

    Status SetCamerasFrom(const Record3dMetadata& metadata, const Record3dFrame& frame) {
        const PinholeCamera& said = metadata.colour_camera;
        Status status = archive_.Read(*frame.image, kR3dMostBytes, bytes_);
        const auto colour = status.ok() ? ReadJpegSize(bytes_) : std::nullopt;
        if (!colour) return Status::Error("its first images are damaged, or no JPEG");
        const PinholeCamera camera = ScaledTo(said, colour->width, colour->height);
        if (std::abs(camera.fx * said.fy / (camera.fy * said.fx) - 1) > 0.02)
            return Status::Error(fmt::format("has images of {}, but a camera of {}",
                                             R3dSizeText(camera), R3dSizeText(said)));
        status = archive_.Read(*frame.depth, kR3dMostBytes, bytes_);
        const auto bytes = status.ok() ? LzfseSize(bytes_) : std::nullopt;
        if (!bytes) return Status::Error("its first depth images are damaged, or no LZFSE");
        const ImageSize depth = Record3dDepthSize(metadata.depth_size, *colour, *bytes);
        if (depth.width == 0)
            return Status::Error(fmt::format(
                "has depth images of {} bytes, which fit neither its metadata ({} x {} pixels) nor "
                "the shape of its images",
                *bytes, metadata.depth_size.width, metadata.depth_size.height));
        info_.colour_camera.pinhole = camera;
        info_.depth_camera.pinhole = ScaledTo(camera, depth.width, depth.height);
        info_.depth_camera.depth_scale = kR3dUnitsPerMetre;
        info_.depth_in_m = true;
        if (ReadConfidence(frame).ok() && !confidence_.empty())
            info_.notes.push_back("depth of confidence 0 is left out");
        return {};
    }

    Status LoadColour(const Record3dFrame& frame, ColourImage& colour) {
        const PinholeCamera& camera = info_.colour_camera.pinhole;
        Status status = archive_.Read(*frame.image, kR3dMostBytes, bytes_);
        if (status.ok() && ReadJpegSize(bytes_) != ImageSize{camera.width, camera.height})
            status = Status::Error("is damaged, or not of " + R3dSizeText(camera));
        if (status.ok()) status = DecodeJpeg(bytes_, kR3dMostSide_px, colour);
        return status.ok() ? status : Status::Error("colour " + status.message());
    }

    Status LoadDepth(const Record3dFrame& frame, Image<std::uint16_t>& depth) {
        const PinholeCamera& camera = info_.depth_camera.pinhole;
        if (Status status = archive_.Read(*frame.depth, kR3dMostBytes, bytes_); !status.ok())
            return Status::Error("depth " + status.message());
        depth.Resize(camera.width, camera.height);
        depth_m_.resize(depth.size());
        if (!DecodeLzfse(bytes_, {reinterpret_cast<std::uint8_t*>(depth_m_.data()),
                                  depth_m_.size() * sizeof(float)}))
            return Status::Error("depth is damaged, or not of " + R3dSizeText(camera));
        if (Status status = ReadConfidence(frame); !status.ok()) return status;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            const bool sure = confidence_.empty() || confidence_[i] > 0;
            depth.data()[i] = sure ? StoredR3dDepth(depth_m_[i]) : std::uint16_t{0};
        }
        return {};
    }

    // Only the sensor on the back has it; otherwise there is no file, or one of 0 pixels.
    Status ReadConfidence(const Record3dFrame& frame) {
        const PinholeCamera& camera = info_.depth_camera.pinhole;
        confidence_.clear();
        if (!frame.confidence) return {};
        if (Status status = archive_.Read(*frame.confidence, kR3dMostBytes, bytes_); !status.ok())
            return Status::Error("confidence " + status.message());
        if (bytes_.empty() || LzfseSize(bytes_) == 0u) return {};
        confidence_.resize(static_cast<std::size_t>(camera.width) *
                           static_cast<std::size_t>(camera.height));
        if (DecodeLzfse(bytes_, confidence_)) return {};
        return Status::Error("confidence is damaged, or not of " + R3dSizeText(camera));
    }

    ZipFile archive_;
    RecordingInfo info_;
    std::vector<Record3dFrame> frames_;
    std::vector<std::uint8_t> bytes_, confidence_;
    std::vector<float> depth_m_;
};

}  // namespace

RecordingResult OpenRecord3d(const std::string& path) {
    Result<ZipFile> archive = ZipFile::Open(path);
    if (!archive.ok()) return archive.status();
    try {
        auto recording = std::make_unique<Record3dRecording>(std::move(archive.value()));
        if (Status status = recording->Start(); !status.ok())
            return Status::Error(fmt::format("{}: {}; export it from Record3D again, as .r3d", path,
                                             status.message()));
        return std::unique_ptr<Recording>(std::move(recording));
    } catch (const std::bad_alloc&) {
        return Status::Error(path + ": does not fit in memory");
    }
}

}  // namespace tessera
