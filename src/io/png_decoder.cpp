#include "io/png_decoder.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace tessera {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kChunkFrame = 12;         // length, type and checksum around a chunk's data
constexpr std::size_t kMaxDeflateRatio = 1032;  // largest possible expansion of one compressed byte

std::uint32_t BigEndian32(const std::uint8_t* p) {
    return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

std::size_t RowBytes(const PngHeader& header) {
    return static_cast<std::size_t>(header.width) *
           static_cast<std::size_t>(header.channels * header.bit_depth / 8);
}

// Returns the neighbour (left, above, above left) nearest to left + above - above left; PNG
// specification 9.4.
inline int Paeth(int left, int above, int above_left) {
    const int from_left = std::abs(above - above_left);
    const int from_above = std::abs(left - above_left);
    const int from_above_left = std::abs(left + above - 2 * above_left);
    const int nearer = from_above < from_left ? above : left;
    return from_above_left < std::min(from_left, from_above) ? above_left : nearer;
}

// Undoes one row's filter in place. `above` is the row above, already unfiltered. kStep is the
// number of bytes per pixel.
template <int kStep>
bool Unfilter(int filter, std::uint8_t* row, const std::uint8_t* above, std::size_t size) {
    std::array<int, kStep> left{};
    std::array<int, kStep> above_left{};
    const auto each = [&](auto predict) {
        for (std::size_t i = 0; i < size; i += kStep)
            for (std::size_t c = 0; c < kStep; ++c) {
                const int up = above[i + c];
                left[c] = (row[i + c] + predict(left[c], up, above_left[c])) & 0xff;
                above_left[c] = up;
                row[i + c] = static_cast<std::uint8_t>(left[c]);
            }
    };
    switch (filter) {
        case 0: return true;
        case 1: each([](int a, int, int) { return a; }); return true;
        case 2:
            for (std::size_t i = 0; i < size; ++i)
                row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
            return true;
        case 3: each([](int a, int b, int) { return (a + b) / 2; }); return true;
        case 4: each(Paeth); return true;
        default: return false;
    }
}

bool UnfilterRow(int step, int filter, std::uint8_t* row, const std::uint8_t* above,
                 std::size_t size) {
    switch (step) {
        case 1: return Unfilter<1>(filter, row, above, size);
        case 2: return Unfilter<2>(filter, row, above, size);
        case 3: return Unfilter<3>(filter, row, above, size);
        case 4: return Unfilter<4>(filter, row, above, size);
        case 6: return Unfilter<6>(filter, row, above, size);
        default: return Unfilter<8>(filter, row, above, size);
    }
}

// Calls store(y, bytes) for every row while it is still in the cache.
template <class Store>
Status UnfilterAll(std::vector<std::uint8_t>& rows, const PngHeader& header, Store store) {
    const std::size_t size = RowBytes(header);
    const std::vector<std::uint8_t> nothing(size, 0);
    const std::uint8_t* above = nothing.data();
    for (int y = 0; y < header.height; ++y) {
        std::uint8_t* row = rows.data() + static_cast<std::size_t>(y) * (size + 1);
        if (!UnfilterRow(header.channels * header.bit_depth / 8, row[0], row + 1, above, size))
            return Status::Error(fmt::format("row {} has the unknown filter {}", y, row[0]));
        store(y, row + 1);
        above = row + 1;
    }
    return Status::Ok();
}

// Joins the image's data chunks. Ignores anything after the last complete chunk; if data is
// missing, inflating fails.
Status GatherData(std::span<const std::uint8_t> file, std::vector<std::uint8_t>& data) {
    data.clear();
    for (std::size_t at = kSignature.size(); at + kChunkFrame <= file.size();) {
        const std::size_t length = BigEndian32(&file[at]);
        if (length > file.size() - at - kChunkFrame) break;
        const std::uint8_t* type = &file[at + 4];
        if (std::memcmp(type, "IEND", 4) == 0) break;
        if (std::memcmp(type, "IDAT", 4) == 0) {
            if (libdeflate_crc32(0, type, length + 4) != BigEndian32(type + 4 + length))
                return Status::Error("is damaged: a checksum is wrong");
            data.insert(data.end(), type + 4, type + 4 + length);
        }
        at += length + kChunkFrame;
    }
    return Status::Ok();
}

}  // namespace

struct PngDecoder::Inflater {
    libdeflate_decompressor* state = libdeflate_alloc_decompressor();
    ~Inflater() { libdeflate_free_decompressor(state); }
};

PngDecoder::PngDecoder() : inflater_(std::make_unique<Inflater>()) {}
PngDecoder::~PngDecoder() = default;
PngDecoder::PngDecoder(PngDecoder&&) noexcept = default;
PngDecoder& PngDecoder::operator=(PngDecoder&&) noexcept = default;

bool IsPng(std::span<const std::uint8_t> file) {
    return file.size() >= kSignature.size() &&
           std::equal(kSignature.begin(), kSignature.end(), file.begin());
}

std::optional<PngHeader> ReadPngHeader(std::span<const std::uint8_t> file) {
    constexpr std::size_t kHeaderLength = 13;
    if (!IsPng(file) || file.size() < kSignature.size() + kChunkFrame + kHeaderLength)
        return std::nullopt;
    const std::uint8_t* chunk = &file[kSignature.size()];
    if (BigEndian32(chunk) != kHeaderLength || std::memcmp(chunk + 4, "IHDR", 4) != 0)
        return std::nullopt;
    if (libdeflate_crc32(0, chunk + 4, kHeaderLength + 4) != BigEndian32(chunk + 8 + kHeaderLength))
        return std::nullopt;
    const std::uint8_t* data = chunk + 8;
    const std::uint32_t width = BigEndian32(data), height = BigEndian32(data + 4);
    constexpr std::uint32_t kLimit = 1u << 30;
    if (width == 0 || height == 0 || width > kLimit || height > kLimit) return std::nullopt;
    PngHeader header;
    header.width = static_cast<int>(width);
    header.height = static_cast<int>(height);
    header.bit_depth = data[8];
    const int colour_type = data[9];
    header.palette = colour_type == 3;
    constexpr std::array<int, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
    header.channels = colour_type < 7 ? kChannels[static_cast<std::size_t>(colour_type)] : 0;
    header.interlaced = data[12] != 0;
    if (header.channels == 0) return std::nullopt;
    return header;
}

Status PngDecoder::Inflate(std::span<const std::uint8_t> file, const PngHeader& header) {
    if (Status status = GatherData(file, compressed_); !status.ok()) return status;
    const std::size_t size = (RowBytes(header) + 1) * static_cast<std::size_t>(header.height);
    if (size / kMaxDeflateRatio > compressed_.size())  // check before allocating
        return Status::Error(
            fmt::format("is truncated or damaged: too little data for {} x {} pixels", header.width,
                        header.height));
    rows_.resize(size);
    if (libdeflate_zlib_decompress(inflater_->state, compressed_.data(), compressed_.size(),
                                   rows_.data(), rows_.size(), nullptr) != LIBDEFLATE_SUCCESS)
        return Status::Error("is truncated or damaged");
    return Status::Ok();
}

Status PngDecoder::DecodeColour(std::span<const std::uint8_t> file, const PngHeader& header,
                                ColourImage& image) {
    if (Status status = Inflate(file, header); !status.ok()) return status;
    image.Resize(header.width, header.height);
    const std::size_t bytes = static_cast<std::size_t>(header.bit_depth / 8);
    const std::size_t step = static_cast<std::size_t>(header.channels) * bytes;
    // Grey: all three channels read the same byte.
    const std::size_t green = header.channels >= 3 ? bytes : 0;
    return UnfilterAll(rows_, header, [&](int y, const std::uint8_t* p) {
        Rgb8* out = image.row(y);
        if (step == sizeof(Rgb8)) {
            std::memcpy(out, p, step * static_cast<std::size_t>(header.width));
            return;
        }
        for (int x = 0; x < header.width; ++x, p += step) out[x] = {p[0], p[green], p[2 * green]};
    });
}

Status PngDecoder::DecodeDepth(std::span<const std::uint8_t> file, const PngHeader& header,
                               Image<std::uint16_t>& image) {
    TESSERA_CHECK(header.channels == 1 && header.bit_depth == 16, "{} channels of {} bits",
                  header.channels, header.bit_depth);
    if (Status status = Inflate(file, header); !status.ok()) return status;
    image.Resize(header.width, header.height);
    return UnfilterAll(rows_, header, [&](int y, const std::uint8_t* p) {
        std::uint16_t* out = image.row(y);
        for (int x = 0; x < header.width; ++x, p += 2)
            out[x] = static_cast<std::uint16_t>(p[0] << 8 | p[1]);
    });
}

}  // namespace tessera
