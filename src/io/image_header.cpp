#include "io/image_header.h"

#include <algorithm>
#include <string_view>

#include "io/jpeg_decoder.h"
#include "io/png_decoder.h"

namespace tessera {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::optional<ImageSize> Size(std::uint64_t width, std::uint64_t height) {
    constexpr std::uint64_t kLimit = 1u << 30;
    if (width == 0 || height == 0 || width > kLimit || height > kLimit) return std::nullopt;
    return ImageSize{static_cast<int>(width), static_cast<int>(height)};
}

// An unsigned number of `count` bytes; 0 beyond the end of the file.
std::uint64_t Number(Bytes file, std::uint64_t at, std::size_t count, bool little) {
    if (at > file.size() || count > file.size() - at) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | file[at + (little ? count - 1 - i : i)];
    return value;
}

bool StartsWith(Bytes file, std::string_view text) {
    return file.size() >= text.size() && std::equal(text.begin(), text.end(), file.begin());
}

// "P5 640 480": numbers between blanks and comments. A blank ends a number, or the decoder would
// read on differently.
std::optional<ImageSize> PnmSize(Bytes file) {
    const auto blank = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    const auto digit = [](std::uint8_t c) { return c >= '0' && c <= '9'; };
    std::uint64_t sides[2] = {};
    std::size_t at = 2;
    for (std::uint64_t& side : sides) {
        while (at < file.size() && (blank(file[at]) || file[at] == '#'))
            if (file[at++] == '#')
                while (at < file.size() && file[at] != '\n' && file[at] != '\r') ++at;
        for (; at < file.size() && digit(file[at]) && side < (1u << 31); ++at)
            side = 10 * side + (file[at] - '0');
        if (at >= file.size() || !blank(file[at])) return std::nullopt;
    }
    return Size(sides[0], sides[1]);
}

std::optional<ImageSize> BmpSize(Bytes file) {
    constexpr std::uint64_t kOldHeader = 12;  // its sizes have two bytes
    const bool old = Number(file, 14, 4, true) == kOldHeader;
    const std::uint64_t width = Number(file, 18, old ? 2 : 4, true);
    const std::uint64_t height = Number(file, old ? 20 : 22, old ? 2 : 4, true);
    // A negative height means rows from top to bottom.
    return Size(width, !old && height > (1u << 31) ? (std::uint64_t{1} << 32) - height : height);
}

// The first directory of the file.
std::optional<ImageSize> TiffSize(Bytes file) {
    constexpr std::uint64_t kWidth = 256, kHeight = 257, kShort = 3, kEntryBytes = 12;
    const bool little = file[0] == 'I';
    const std::uint64_t directory = Number(file, 4, 4, little);
    const std::uint64_t entries = Number(file, directory, 2, little);
    std::uint64_t width = 0, height = 0;
    for (std::uint64_t i = 0; i < entries; ++i) {
        const std::uint64_t at = directory + 2 + i * kEntryBytes;
        const std::uint64_t tag = Number(file, at, 2, little);
        const bool is_short = Number(file, at + 2, 2, little) == kShort;
        if (tag != kWidth && tag != kHeight) continue;
        std::uint64_t& side = tag == kWidth ? width : height;
        if (side == 0) side = Number(file, at + 8, is_short ? 2 : 4, little);
    }
    return Size(width, height);
}

}  // namespace

std::optional<ImageSize> ReadImageSize(Bytes file) {
    if (IsJpeg(file)) return ReadJpegSize(file);
    if (IsPng(file)) {
        const auto header = ReadPngHeader(file);
        return header ? std::optional(ImageSize{header->width, header->height}) : std::nullopt;
    }
    if (StartsWith(file, "BM")) return BmpSize(file);
    if (StartsWith(file, {"II*\0", 4}) || StartsWith(file, {"MM\0*", 4})) return TiffSize(file);
    if (file.size() > 2 && file[0] == 'P' && file[1] >= '1' && file[1] <= '6') return PnmSize(file);
    return std::nullopt;
}

}  // namespace tessera
