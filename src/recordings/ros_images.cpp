#include "recordings/ros_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/printable.h"
#include "io/image_decoder.h"
#include "io/jpeg_decoder.h"
#include "io/png_decoder.h"
#include "recordings/rvl.h"

namespace tessera {
namespace {

constexpr double kUnitsOfFloats = 5000;  // per metre; up to 13 m

struct ColourLayout {
    const char* encoding;
    std::uint32_t bytes, r, g, b;  // of a pixel, and where its channels are
};
constexpr std::array kColourLayouts{
    ColourLayout{"rgb8", 3, 0, 1, 2},  ColourLayout{"bgr8", 3, 2, 1, 0},
    ColourLayout{"rgba8", 4, 0, 1, 2}, ColourLayout{"bgra8", 4, 2, 1, 0},
    ColourLayout{"mono8", 1, 0, 0, 0}, ColourLayout{"8UC1", 1, 0, 0, 0},
    ColourLayout{"8UC3", 3, 2, 1, 0}};

// Two pixels in four bytes: where the first luma and the two chroma values are.
struct YuvLayout {
    const char* encoding;
    std::uint32_t y, u, v;
};
constexpr std::array kYuvLayouts{YuvLayout{"yuv422", 1, 0, 2}, YuvLayout{"uyvy", 1, 0, 2},
                                 YuvLayout{"yuv422_yuy2", 0, 1, 3}, YuvLayout{"yuyv", 0, 1, 3}};

template <class Layouts>
auto LayoutOf(const Layouts& layouts, std::string_view encoding) {
    const auto found =
        std::ranges::find_if(layouts, [&](const auto& l) { return l.encoding == encoding; });
    return found == layouts.end() ? nullptr : &*found;
}

Status CheckSize(std::uint32_t width, std::uint32_t height) {
    constexpr auto kMost = static_cast<std::uint32_t>(ImageDecoder::kMaxSide_px);
    if (width == 0 || height == 0 || width > kMost || height > kMost)
        return Status::Error(fmt::format("an image of {} x {} pixels", width, height));
    return {};
}

Status CheckSize(const RosImage& message, std::uint32_t pixel_bytes) {
    if (Status status = CheckSize(message.width, message.height); !status.ok()) return status;
    if (message.row_bytes < message.width * pixel_bytes)
        return Status::Error("the rows of an image are shorter than its width");
    return {};
}

std::uint16_t StoredDepth(float z_m) {
    const float units = z_m * static_cast<float>(kUnitsOfFloats);
    return units > 0 && units < 65535.5f ? static_cast<std::uint16_t>(units + 0.5f) : 0;
}

std::uint8_t Clamped(float value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

Rgb8 FromYuv(std::uint8_t y8, std::uint8_t u8, std::uint8_t v8) {
    const auto y = static_cast<float>(y8), u = static_cast<float>(u8) - 128,
               v = static_cast<float>(v8) - 128;
    return {Clamped(y + 1.402f * v), Clamped(y - 0.344136f * u - 0.714136f * v),
            Clamped(y + 1.772f * u)};
}

Status DecodeYuv(const RosImage& message, const YuvLayout& layout, ColourImage& colour) {
    if (Status status = CheckSize(message, 2); !status.ok()) return status;
    if (message.width % 2 != 0) return Status::Error("a YUV image of odd width");
    colour.Resize(static_cast<int>(message.width), static_cast<int>(message.height));
    for (int y = 0; y < colour.height(); ++y) {
        const std::uint8_t* row =
            message.data.data() + static_cast<std::size_t>(y) * message.row_bytes;
        for (int x = 0; x < colour.width(); x += 2, row += 4) {
            colour(x, y) = FromYuv(row[layout.y], row[layout.u], row[layout.v]);
            colour(x + 1, y) = FromYuv(row[layout.y + 2], row[layout.u], row[layout.v]);
        }
    }
    return {};
}

Status DecodePng16(ByteView file, Image<std::uint16_t>& depth) {
    const auto header = ReadPngHeader(file);
    if (!header || !header->common() || header->bit_depth != 16 || header->channels != 1)
        return Status::Error("compressed depth is no PNG of 16 bits");
    if (std::max(header->width, header->height) > ImageDecoder::kMaxSide_px)
        return Status::Error("a depth image that is too large");
    return PngDecoder().DecodeDepth(file, *header, depth);
}

// Width and height, then the code.
Status DecodeRvlImage(ByteView file, Image<std::uint16_t>& depth) {
    std::uint32_t size[2];
    if (file.size() < sizeof(size)) return Status::Error("compressed depth is empty");
    std::memcpy(size, file.data(), sizeof(size));
    if (Status status = CheckSize(size[0], size[1]); !status.ok()) return status;
    depth.Resize(static_cast<int>(size[0]), static_cast<int>(size[1]));
    if (!DecodeRvl(file.subspan(sizeof(size)), {depth.data(), depth.size()}))
        return Status::Error("compressed depth (RVL) is cut off or damaged");
    return {};
}

}  // namespace

bool IsDepthEncoding(std::string_view encoding) {
    return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1";
}

bool IsColourEncoding(std::string_view encoding) {
    return LayoutOf(kColourLayouts, encoding) != nullptr ||
           LayoutOf(kYuvLayouts, encoding) != nullptr;
}

bool IsRosDepthInMetres(std::string_view encoding_or_format) {
    return encoding_or_format.starts_with("32FC1");
}

double RosDepthScale(std::string_view encoding_or_format) {
    return IsRosDepthInMetres(encoding_or_format) ? kUnitsOfFloats : 1000;
}

Status DecodeRosDepth(const RosImage& message, Image<std::uint16_t>& depth) {
    const bool floats = message.encoding == "32FC1";
    if (!IsDepthEncoding(message.encoding))
        return Status::Error("depth in the encoding " + Printable(message.encoding, kQuotedBytes));
    if (Status status = CheckSize(message, floats ? 4 : 2); !status.ok()) return status;
    if (message.big_endian && floats) return Status::Error("big-endian floats");
    depth.Resize(static_cast<int>(message.width), static_cast<int>(message.height));
    for (int y = 0; y < depth.height(); ++y) {
        const std::uint8_t* row =
            message.data.data() + static_cast<std::size_t>(y) * message.row_bytes;
        std::uint16_t* target = depth.row(y);
        if (floats) {
            for (int x = 0; x < depth.width(); ++x) {
                float z_m;
                std::memcpy(&z_m, row + 4 * x, sizeof(z_m));
                target[x] = StoredDepth(z_m);
            }
            continue;
        }
        std::memcpy(target, row, 2 * static_cast<std::size_t>(depth.width()));
        if (message.big_endian)
            for (int x = 0; x < depth.width(); ++x)
                target[x] = static_cast<std::uint16_t>(target[x] << 8 | target[x] >> 8);
    }
    return {};
}

Status DecodeRosColour(const RosImage& message, ColourImage& colour) {
    if (const YuvLayout* yuv = LayoutOf(kYuvLayouts, message.encoding))
        return DecodeYuv(message, *yuv, colour);
    const ColourLayout* layout = LayoutOf(kColourLayouts, message.encoding);
    if (layout == nullptr)
        return Status::Error("colour in the encoding " + Printable(message.encoding, kQuotedBytes));
    if (Status status = CheckSize(message, layout->bytes); !status.ok()) return status;
    colour.Resize(static_cast<int>(message.width), static_cast<int>(message.height));
    for (int y = 0; y < colour.height(); ++y) {
        const std::uint8_t* pixel =
            message.data.data() + static_cast<std::size_t>(y) * message.row_bytes;
        for (int x = 0; x < colour.width(); ++x, pixel += layout->bytes)
            colour(x, y) = {pixel[layout->r], pixel[layout->g], pixel[layout->b]};
    }
    return {};
}

Status DecodeRosDepth(const RosCompressedImage& message, Image<std::uint16_t>& depth) {
    // Before the image: the kind, and two numbers a and b of inverse depth, z = a / (stored - b).
    constexpr std::size_t kHead = 12;
    ByteView file = message.data;
    float a = 0, b = 0;
    if (!IsPng(file) && file.size() > kHead) {
        std::memcpy(&a, file.data() + 4, sizeof(a));
        std::memcpy(&b, file.data() + 8, sizeof(b));
        file = file.subspan(kHead);
    }
    const bool is_rvl = message.format.find("compressedDepth rvl") != std::string_view::npos;
    Status status = is_rvl ? DecodeRvlImage(file, depth) : DecodePng16(file, depth);
    if (!status.ok() || !IsRosDepthInMetres(message.format)) return status;
    std::for_each_n(depth.data(), depth.size(), [&](std::uint16_t& stored) {
        if (stored != 0) stored = StoredDepth(a / (static_cast<float>(stored) - b));
    });
    return {};
}

Status DecodeRosColour(const RosCompressedImage& message, ColourImage& colour) {
    if (IsJpeg(message.data)) return DecodeJpeg(message.data, ImageDecoder::kMaxSide_px, colour);
    const auto header = ReadPngHeader(message.data);
    if (!header || !header->common() ||
        std::max(header->width, header->height) > ImageDecoder::kMaxSide_px)
        return Status::Error("compressed colour is neither a JPEG nor a usual PNG");
    return PngDecoder().DecodeColour(message.data, *header, colour);
}

}  // namespace tessera
