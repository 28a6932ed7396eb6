#include "recordings/stray_video.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "core/input_file.h"
#include "io/image_decoder.h"

namespace tessera {
namespace {

// FFmpeg would also open play lists and whatever else the content resembles.
Status CheckIsMp4(const std::string& path) {
    const Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    std::uint8_t head[8]{};
    if (!file.value().ReadAt(0, head).ok() || std::memcmp(head + 4, "ftyp", 4) != 0)
        return Status::Error(path + ": is no MP4 video");
    return {};
}

// A whole number that a video claims; 0 if it makes no sense.
std::int64_t StrayCount(double claimed) {
    constexpr double kMost = 1e9;
    return claimed >= 1 && claimed <= kMost ? std::llround(claimed) : 0;
}

}  // namespace

struct StrayVideo::Decoder {
    cv::VideoCapture capture;
    cv::Mat bgr;
};

StrayVideo::StrayVideo(std::string path)
    : path_(std::move(path)), decoder_(std::make_unique<Decoder>()) {}
StrayVideo::~StrayVideo() = default;
StrayVideo::StrayVideo(StrayVideo&&) noexcept = default;
StrayVideo& StrayVideo::operator=(StrayVideo&&) noexcept = default;

Result<StrayVideo> StrayVideo::Open(const std::string& path) {
    if (Status status = CheckIsMp4(path); !status.ok()) return status;
    StrayVideo video(path);
    try {
        if (!cv::videoio_registry::hasBackend(cv::CAP_FFMPEG))
            return Status::Error(path + ": OpenCV was built without FFmpeg, which reads videos");
        if (Status status = video.Start(); !status.ok()) return status;
        const std::int64_t width =
            StrayCount(video.decoder_->capture.get(cv::CAP_PROP_FRAME_WIDTH));
        const std::int64_t height =
            StrayCount(video.decoder_->capture.get(cv::CAP_PROP_FRAME_HEIGHT));
        constexpr int kMost_px = ImageDecoder::kMaxSide_px;
        if (width < 1 || height < 1 || width > kMost_px || height > kMost_px)
            return Status::Error(
                fmt::format("{}: {} x {} pixels; at most {} per side are supported", path, width,
                            height, kMost_px));
        video.width_ = static_cast<int>(width);
        video.height_ = static_cast<int>(height);
        video.frame_count_ = StrayCount(video.decoder_->capture.get(cv::CAP_PROP_FRAME_COUNT));
        const double fps = video.decoder_->capture.get(cv::CAP_PROP_FPS);
        constexpr double kMostFps = 1000;
        video.fps_ = fps >= 1 && fps <= kMostFps ? fps : 0;
    } catch (const std::exception& error) {
        return Status::Error(fmt::format("{}: cannot be decoded: {}", path, error.what()));
    }
    return Result<StrayVideo>(std::move(video));
}

Status StrayVideo::Start() {
    next_ = 0;
    ended_ = false;
    if (!decoder_->capture.open(path_, cv::CAP_FFMPEG))
        return Status::Error(path_ + ": is no video, is damaged, or has an unknown compression");
    decoder_->capture.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
    return {};
}

Status StrayVideo::Read(std::uint64_t index, ColourImage& image) {
    try {
        return ReadFrame(index, image);
    } catch (const std::exception& error) {
        decoder_->capture.release();  // the next call starts again
        return Status::Error(
            fmt::format("frame {} of the video cannot be decoded: {}", index, error.what()));
    }
}

Status StrayVideo::ReadFrame(std::uint64_t index, ColourImage& image) {
    const bool passed = index + 1 < next_ || (ended_ && index < next_);
    if (!decoder_->capture.isOpened() || passed)
        if (Status status = Start(); !status.ok()) return status;
    for (; next_ <= index; ++next_) {
        // What can be decoded after damage would have wrong numbers.
        ended_ = ended_ || !decoder_->capture.grab();
        if (ended_)
            return Status::Error(
                fmt::format("the video ends at frame {}, or is damaged there", next_));
    }
    if (!decoder_->capture.retrieve(decoder_->bgr) || decoder_->bgr.type() != CV_8UC3 ||
        decoder_->bgr.cols != width_ || decoder_->bgr.rows != height_)
        return Status::Error(fmt::format("frame {} of the video is damaged", index));
    image.Resize(width_, height_);
    cv::Mat rgb(height_, width_, CV_8UC3, image.data());
    cv::cvtColor(decoder_->bgr, rgb, cv::COLOR_BGR2RGB);
    return {};
}

}  // namespace tessera
