#include "io/image_decoder.h"

#include <cstring>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/input_file.h"
#include "io/jpeg_decoder.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxImageBytes = std::size_t{512} << 20;

Status RefuseDepth(int bits, int channels) {
    return Status::Error(
        fmt::format("has {} bits and {} channel{}; depth needs 16 bits and 1 channel", bits,
                    channels, channels == 1 ? "" : "s"));
}

// For formats that our own decoders do not handle. The orientation that some of them store is
// ignored: colour and depth must stay in register.
Result<cv::Mat> DecodeWithOpenCv(std::vector<std::uint8_t>& file, ImageSize size, int flags) {
    try {
        cv::Mat image = cv::imdecode(file, flags);
        if (image.cols != size.width || image.rows != size.height)
            return Status::Error("is not an image, or is truncated or damaged");
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

Result<ImageSize> ImageDecoder::Load(const std::string& path) {
    path_ = path;
    if (Status status = ReadFileBytes(path, kMaxImageBytes, file_); !status.ok()) return status;
    if (file_.empty()) return Status::Error(path + ": is empty");
    const std::optional<ImageSize> size = ReadImageSize(file_);
    if (!size)
        return Status::Error(path +
                             ": is not an image, or is truncated or damaged (read are PNG, JPEG, "
                             "PNM, BMP and TIFF)");
    if (size->width > kMaxSide_px || size->height > kMaxSide_px)
        return Status::Error(fmt::format("{}: {} x {} pixels; at most {} per side are supported",
                                         path, size->width, size->height, kMaxSide_px));
    size_ = *size;
    return size_;
}

Status ImageDecoder::ReadColour(const std::string& path, ColourImage& image) {
    const Result<ImageSize> size = Load(path);
    return size.ok() ? DecodeColour(image) : size.status();
}

Status ImageDecoder::ReadDepth(const std::string& path, Image<std::uint16_t>& image) {
    const Result<ImageSize> size = Load(path);
    return size.ok() ? DecodeDepth(image) : size.status();
}

Status ImageDecoder::DecodeColour(ColourImage& image) {
    return Named(path_, [&] { return DecodeLoadedColour(image); });
}

Status ImageDecoder::DecodeDepth(Image<std::uint16_t>& image) {
    return Named(path_, [&] { return DecodeLoadedDepth(image); });
}

Status ImageDecoder::DecodeLoadedColour(ColourImage& image) {
    if (IsJpeg(file_)) return DecodeJpeg(file_, kMaxSide_px, image);
    if (const auto header = ReadPngHeader(file_); header && header->common())
        return png_.DecodeColour(file_, *header, image);
    const Result<cv::Mat> decoded =
        DecodeWithOpenCv(file_, size_, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    if (!decoded.ok()) return decoded.status();
    image.Resize(decoded.value().cols, decoded.value().rows);
    cv::Mat rgb(image.height(), image.width(), CV_8UC3, image.data());
    cv::cvtColor(decoded.value(), rgb, cv::COLOR_BGR2RGB);
    return Status::Ok();
}

Status ImageDecoder::DecodeLoadedDepth(Image<std::uint16_t>& image) {
    if (const auto header = ReadPngHeader(file_)) {
        if (header->bit_depth != 16 || header->channels != 1)
            return RefuseDepth(header->bit_depth, header->channels);
        if (header->common()) return png_.DecodeDepth(file_, *header, image);
    }
    const Result<cv::Mat> decoded = DecodeWithOpenCv(file_, size_, cv::IMREAD_UNCHANGED);
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
