#include "recordings/mkv_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"

namespace tessera {
namespace {

// Images without compression, and how OpenCV converts them.
struct MkvRawFormat {
    std::string_view name;
    int bits;               // of a pixel
    int type, rows_of_two;  // OpenCV's type, and how many of its rows make two rows of the image
    int conversion;
};
constexpr std::array kMkvRawFormats{MkvRawFormat{"NV12", 12, CV_8UC1, 3, cv::COLOR_YUV2RGB_NV12},
                                    MkvRawFormat{"YUY2", 16, CV_8UC2, 2, cv::COLOR_YUV2RGB_YUY2},
                                    MkvRawFormat{"BGRA", 32, CV_8UC4, 2, cv::COLOR_BGRA2RGB}};

Status CheckMkvBytes(MkvBytes bytes, ImageSize size, int bits) {
    const std::size_t expected = static_cast<std::size_t>(size.width) *
                                 static_cast<std::size_t>(size.height) *
                                 static_cast<std::size_t>(bits) / 8;
    if (bytes.size() == expected) return {};
    return Status::Error(fmt::format("has {} bytes instead of {}", bytes.size(), expected));
}

}  // namespace

bool IsMkvDepthFormat(std::string_view format) { return format == "b16g"; }

bool IsMkvColourFormat(std::string_view format) {
    return format == "MJPG" || std::ranges::count(kMkvRawFormats, format, &MkvRawFormat::name) > 0;
}

Status DecodeMkvDepth(MkvBytes bytes, ImageSize size, Image<std::uint16_t>& depth) {
    if (Status status = CheckMkvBytes(bytes, size, 16); !status.ok()) return status;
    depth.Resize(size.width, size.height);
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth.data()[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
    return {};
}

Status DecodeMkvColour(std::string_view format, MkvBytes bytes, ImageSize size,
                       ColourImage& colour) {
    if (format == "MJPG") {
        if (!IsJpeg(bytes) || ReadJpegSize(bytes) != size)
            return Status::Error(
                fmt::format("is no JPEG image of {} x {} pixels", size.width, size.height));
        return DecodeJpeg(bytes, ImageDecoder::kMaxSide_px, colour);
    }
    const auto raw = std::ranges::find(kMkvRawFormats, format, &MkvRawFormat::name);
    TESSERA_CHECK(raw != kMkvRawFormats.end(), "colour of the format {}", format);
    if (size.width % 2 != 0 || size.height % 2 != 0)
        return Status::Error("has an odd width or height");
    if (Status status = CheckMkvBytes(bytes, size, raw->bits); !status.ok()) return status;
    colour.Resize(size.width, size.height);
    const cv::Mat from(size.height / 2 * raw->rows_of_two, size.width, raw->type,
                       const_cast<std::uint8_t*>(bytes.data()));
    cv::Mat to(size.height, size.width, CV_8UC3, colour.data());
    cv::cvtColor(from, to, raw->conversion);
    return {};
}

}  // namespace tessera
