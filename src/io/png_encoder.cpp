#include "io/png_encoder.h"

#include <libdeflate.h>

#include <cstring>

#include "core/check.h"

namespace tessera {
namespace {

constexpr int kLevel = 1;
constexpr std::uint8_t kNoFilter = 0, kLeftFilter = 1;  // PNG specification 9.2
constexpr int kGrey = 0, kRgb = 2;                      // PNG specification 11.2.2

void PutBigEndian32(std::size_t value, std::uint8_t* to) {
    for (int i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// Appends length, name, data and checksum.
void AppendChunk(const char* name, const std::uint8_t* data, std::size_t size,
                 std::vector<std::uint8_t>& file) {
    const std::size_t at = file.size();
    file.resize(at + 12 + size);
    PutBigEndian32(size, file.data() + at);
    std::memcpy(file.data() + at + 4, name, 4);
    if (size > 0) std::memcpy(file.data() + at + 8, data, size);
    PutBigEndian32(libdeflate_crc32(0, file.data() + at + 4, 4 + size),
                   file.data() + at + 8 + size);
}

}  // namespace

struct PngEncoder::Deflater {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(kLevel);
    std::vector<std::uint8_t> compressed;
    ~Deflater() { libdeflate_free_compressor(compressor); }
};

PngEncoder::PngEncoder() : deflater_(std::make_unique<Deflater>()) {
    TESSERA_CHECK(deflater_->compressor != nullptr, "out of memory");
}
PngEncoder::~PngEncoder() = default;

// No filter: on a Kinect's depth at the fastest level, no filter type makes the files smaller, and
// all of them cost time.
void PngEncoder::EncodeDepth(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& file) {
    const auto width = static_cast<std::size_t>(image.width());
    rows_.resize((1 + 2 * width) * static_cast<std::size_t>(image.height()));
    std::uint8_t* to = rows_.data();
    for (int y = 0; y < image.height(); ++y, to += 1 + 2 * width) {
        *to = kNoFilter;
        const std::uint16_t* from = image.row(y);
        for (std::size_t x = 0; x < width; ++x) {
            to[1 + 2 * x] = static_cast<std::uint8_t>(from[x] >> 8);
            to[2 + 2 * x] = static_cast<std::uint8_t>(from[x]);
        }
    }
    Encode(image.width(), image.height(), 16, kGrey, file);
}

void PngEncoder::EncodeColour(const ColourImage& image, std::vector<std::uint8_t>& file) {
    static_assert(sizeof(Rgb8) == 3, "rows are read as bytes");
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width());
    rows_.resize((1 + row_bytes) * static_cast<std::size_t>(image.height()));
    std::uint8_t* to = rows_.data();
    for (int y = 0; y < image.height(); ++y, to += 1 + row_bytes) {
        *to = kLeftFilter;
        const auto* from = reinterpret_cast<const std::uint8_t*>(image.row(y));
        std::memcpy(to + 1, from, 3);
        for (std::size_t i = 3; i < row_bytes; ++i)
            to[1 + i] = static_cast<std::uint8_t>(from[i] - from[i - 3]);
    }
    Encode(image.width(), image.height(), 8, kRgb, file);
}

void PngEncoder::Encode(int width, int height, int bit_depth, int colour_type,
                        std::vector<std::uint8_t>& file) {
    std::vector<std::uint8_t>& compressed = deflater_->compressed;
    compressed.resize(libdeflate_zlib_compress_bound(deflater_->compressor, rows_.size()));
    const std::size_t size = libdeflate_zlib_compress(
        deflater_->compressor, rows_.data(), rows_.size(), compressed.data(), compressed.size());
    TESSERA_CHECK(size > 0, "{} bytes do not fit their bound", rows_.size());
    file.assign({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
    std::uint8_t header[13] = {};  // compression, filter and interlace method stay 0
    PutBigEndian32(static_cast<std::size_t>(width), header);
    PutBigEndian32(static_cast<std::size_t>(height), header + 4);
    header[8] = static_cast<std::uint8_t>(bit_depth);
    header[9] = static_cast<std::uint8_t>(colour_type);
    AppendChunk("IHDR", header, sizeof(header), file);
    AppendChunk("IDAT", compressed.data(), size, file);
    AppendChunk("IEND", nullptr, 0, file);
}

}  // namespace tessera
