#include "io/image_decoder.h"

#include <cstring>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/jpeg_decoder.h"
#include "io/read_file.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxImageBytes = std::size_t{512} << 20;

Status CheckSize(int width, int height) {
    if (width <= ImageDecoder::kMaxSide_px && height <= ImageDecoder::kMaxSide_px)
        return Status::Ok();
    return Status::Error(fmt::format("{} x {} pixels; at most {} per side are supported", width,
                                     height, ImageDecoder::kMaxSide_px));
}

Status RefuseDepth(int bits, int channels) {
    return Status::Error(
        fmt::format("has {} bits and {} channel{}; depth needs 16 bits and 1 channel", bits,
                    channels, channels == 1 ? "" : "s"));
}

// For formats that our own decoders do not handle.
Result<cv::Mat> DecodeWithOpenCv(std::vector<std::uint8_t>& file, int flags) {
    try {
        cv::Mat image = cv::imdecode(file, flags);
        if (image.empty()) return Status::Error("is not an image, or is truncated or damaged");
        if (Status status = CheckSize(image.cols, image.rows); !status.ok()) return status;
        return image;
    } catch (const cv::Exception&) {
        return Status::Error("is not an image, or is truncated or damaged");
    }
}

// Prefixes errors with the file name and turns exceptions from libraries into errors.
Status Named(const std::string& path, const std::function<Status()>& decode) {
    try {
        const Status status = decode();
        return status.ok() ? status : Status::Error(path + ": " + status.message());
    } catch (const std::exception& error) {
        return Status::Error(fmt::format("{}: cannot be decoded: {}", path, error.what()));
    }
}

}  // namespace

Status ImageDecoder::ReadColour(const std::string& path, ColourImage& image) {
    if (Status status = ReadFileBytes(path, kMaxImageBytes, file_); !status.ok()) return status;
    return Named(path, [&] { return DecodeColour(image); });
}

Status ImageDecoder::ReadDepth(const std::string& path, Image<std::uint16_t>& image) {
    if (Status status = ReadFileBytes(path, kMaxImageBytes, file_); !status.ok()) return status;
    return Named(path, [&] { return DecodeDepth(image); });
}

Status ImageDecoder::DecodeColour(ColourImage& image) {
    if (file_.empty()) return Status::Error("is empty");
    if (IsJpeg(file_)) return DecodeJpeg(file_, kMaxSide_px, image);
    if (IsPng(file_)) {
        const auto header = ReadPngHeader(file_);
        if (!header) return Status::Error("is truncated or damaged");
        if (Status status = CheckSize(header->width, header->height); !status.ok()) return status;
        if (header->common()) return png_.DecodeColour(file_, *header, image);
    }
    const Result<cv::Mat> decoded = DecodeWithOpenCv(file_, cv::IMREAD_COLOR);
    if (!decoded.ok()) return decoded.status();
    image.Resize(decoded.value().cols, decoded.value().rows);
    cv::Mat rgb(image.height(), image.width(), CV_8UC3, image.data());
    cv::cvtColor(decoded.value(), rgb, cv::COLOR_BGR2RGB);
    return Status::Ok();
}

Status ImageDecoder::DecodeDepth(Image<std::uint16_t>& image) {
    if (file_.empty()) return Status::Error("is empty");
    if (IsPng(file_)) {
        const auto header = ReadPngHeader(file_);
        if (!header) return Status::Error("is truncated or damaged");
        if (Status status = CheckSize(header->width, header->height); !status.ok()) return status;
        if (header->bit_depth != 16 || header->channels != 1)
            return RefuseDepth(header->bit_depth, header->channels);
        if (header->common()) return png_.DecodeDepth(file_, *header, image);
    }
    const Result<cv::Mat> decoded = DecodeWithOpenCv(file_, cv::IMREAD_UNCHANGED);
    if (!decoded.ok()) return decoded.status();
    const cv::Mat& raw = decoded.value();
    if (raw.type() != CV_16UC1)
        return RefuseDepth(static_cast<int>(8 * raw.elemSize1()), raw.channels());
    image.Resize(raw.cols, raw.rows);
    cv::Mat target(raw.rows, raw.cols, CV_16UC1, image.data());
    raw.copyTo(target);
    return Status::Ok();
}

}  // namespace tessera
