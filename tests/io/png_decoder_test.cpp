#include "io/png_decoder.h"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <random>

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

void Append32(Bytes& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void AppendChunk(Bytes& file, const std::string& type, const Bytes& data) {
    Append32(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = file.size();
    file.insert(file.end(), type.begin(), type.end());
    file.insert(file.end(), data.begin(), data.end());
    Append32(file, libdeflate_crc32(0, &file[begin], file.size() - begin));
}

Bytes Compress(const Bytes& data) {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    Bytes compressed(libdeflate_zlib_compress_bound(compressor, data.size()));
    compressed.resize(libdeflate_zlib_compress(compressor, data.data(), data.size(),
                                               compressed.data(), compressed.size()));
    libdeflate_free_compressor(compressor);
    return compressed;
}

int SlowPaeth(int a, int b, int c) {
    const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    if (pa <= pb && pa <= pc) return a;
    return pb <= pc ? b : c;
}

// The filters of the PNG specification, one byte at a time.
Bytes FilterRows(const Bytes& raw, std::size_t row_bytes, std::size_t step,
                 const std::vector<int>& filters) {
    Bytes filtered;
    for (std::size_t y = 0; y * row_bytes < raw.size(); ++y) {
        const int filter = filters[y % filters.size()];
        filtered.push_back(static_cast<std::uint8_t>(filter));
        for (std::size_t x = 0; x < row_bytes; ++x) {
            const auto at = [&](std::size_t back, std::size_t up) {
                return x < back || y < up ? 0 : int{raw[(y - up) * row_bytes + x - back]};
            };
            const int a = at(step, 0), b = at(0, 1), c = at(step, 1);
            const int predictions[] = {0, a, b, (a + b) / 2, SlowPaeth(a, b, c)};
            const int predicted = filter < 5 ? predictions[filter] : 0;
            filtered.push_back(static_cast<std::uint8_t>(at(0, 0) - predicted));
        }
    }
    return filtered;
}

constexpr int kWidth = 23, kHeight = 17;

struct Kind {
    int channels, bits;
};

Bytes RandomBytes(std::size_t size, unsigned seed) {
    std::mt19937 random(seed);
    Bytes bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

// A PNG whose data is split into chunks of 100 bytes.
Bytes MakePng(const Kind& kind, const Bytes& raw, const std::vector<int>& filters,
              int width = kWidth, int height = kHeight) {
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const std::uint8_t colour_type[] = {0, 0, 4, 2, 6};
    Bytes header;
    Append32(header, static_cast<std::uint32_t>(width));
    Append32(header, static_cast<std::uint32_t>(height));
    for (int value : {kind.bits, int{colour_type[kind.channels]}, 0, 0, 0})
        header.push_back(static_cast<std::uint8_t>(value));
    AppendChunk(file, "IHDR", header);
    AppendChunk(file, "tEXt", {'k', 0, 'v'});
    const std::size_t step = static_cast<std::size_t>(kind.channels * kind.bits / 8);
    const Bytes data =
        Compress(FilterRows(raw, step * static_cast<std::size_t>(width), step, filters));
    for (std::size_t at = 0; at < data.size(); at += 100)
        AppendChunk(file, "IDAT", Bytes(&data[at], data.data() + std::min(at + 100, data.size())));
    AppendChunk(file, "IEND", {});
    return file;
}

Bytes MakeDepthPng(const std::vector<int>& filters) {
    return MakePng({1, 16}, RandomBytes(kWidth * kHeight * 2, 1), filters);
}

TEST(PngDecoder, ReadsEveryFilterAndKindAsOpenCvDoes) {
    PngDecoder decoder;
    for (const Kind& kind :
         {Kind{1, 8}, {2, 8}, {3, 8}, {4, 8}, {1, 16}, {2, 16}, {3, 16}, {4, 16}}) {
        SCOPED_TRACE(testing::Message()
                     << kind.channels << " channels of " << kind.bits << " bits");
        const std::size_t step = static_cast<std::size_t>(kind.channels * kind.bits / 8);
        const Bytes file =
            MakePng(kind, RandomBytes(kWidth * kHeight * step, 2), {0, 1, 2, 3, 4, 4, 3, 1});
        const auto header = ReadPngHeader(file);
        ASSERT_TRUE(header && header->common());
        ColourImage image;
        ASSERT_TRUE(decoder.DecodeColour(file, *header, image).ok());
        const cv::Mat expected = cv::imdecode(file, cv::IMREAD_COLOR);
        ASSERT_EQ(expected.cols, image.width());
        ASSERT_EQ(expected.rows, image.height());
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto bgr = expected.at<cv::Vec3b>(y, x);
                ASSERT_EQ(image(x, y), (Rgb8{bgr[2], bgr[1], bgr[0]})) << x << " " << y;
            }
    }
}

TEST(PngDecoder, GivesRawDepth) {
    const Bytes raw = RandomBytes(kWidth * kHeight * 2, 3);
    for (int filter = 0; filter < 5; ++filter) {
        const Bytes file = MakePng({1, 16}, raw, {filter});
        Image<std::uint16_t> depth;
        PngDecoder decoder;
        ASSERT_TRUE(decoder.DecodeDepth(file, *ReadPngHeader(file), depth).ok());
        for (std::size_t i = 0; i < depth.size(); ++i)
            ASSERT_EQ(depth.data()[i], raw[2 * i] << 8 | raw[2 * i + 1]) << filter << " " << i;
    }
}

TEST(PngDecoder, KnowsWhatItLeavesToOthers) {
    Bytes file = MakeDepthPng({0});
    PngHeader header = *ReadPngHeader(file);
    EXPECT_TRUE(header.common());
    header.interlaced = true;
    EXPECT_FALSE(header.common());
    header = {10, 10, 4, 1, false, false};
    EXPECT_FALSE(header.common());
    header = {10, 10, 8, 1, true, false};
    EXPECT_FALSE(header.common());
    file[0] = 'x';
    EXPECT_FALSE(ReadPngHeader(file).has_value());
}

TEST(PngDecoder, RefusesEveryTruncation) {
    const Bytes file = MakeDepthPng({4});
    PngDecoder decoder;
    Image<std::uint16_t> depth;
    const std::size_t end_chunk = 12;
    for (std::size_t size = 0; size < file.size() - end_chunk; ++size) {
        const std::span<const std::uint8_t> part(file.data(), size);
        const auto header = ReadPngHeader(part);
        if (header) {
            EXPECT_FALSE(decoder.DecodeDepth(part, *header, depth).ok()) << size;
        }
    }
}

TEST(PngDecoder, RefusesEveryFlippedBitOfTheData) {
    const Bytes file = MakeDepthPng({1, 4});
    PngDecoder decoder;
    Image<std::uint16_t> depth;
    const std::size_t data_begin = 8 + 25 + 15, end_chunk = 12;
    for (std::size_t at = data_begin; at < file.size() - end_chunk; ++at) {
        Bytes broken = file;
        broken[at] ^= 0x10;
        EXPECT_FALSE(decoder.DecodeDepth(broken, *ReadPngHeader(broken), depth).ok()) << at;
    }
}

TEST(PngDecoder, RefusesAnUnknownFilter) {
    const Bytes file = MakeDepthPng({0, 5});
    Image<std::uint16_t> depth;
    EXPECT_EQ(PngDecoder().DecodeDepth(file, *ReadPngHeader(file), depth).message(),
              "row 1 has the unknown filter 5");
}

// A header of 8192 x 8192 followed by a few bytes must not allocate 128 MB.
TEST(PngDecoder, RefusesMoreThanTheDataCanHoldBeforeAllocating) {
    const Bytes file = MakePng({1, 16}, RandomBytes(8192 * 2, 4), {0}, 8192, 8192);
    Image<std::uint16_t> depth;
    EXPECT_EQ(PngDecoder().DecodeDepth(file, *ReadPngHeader(file), depth).message(),
              "is truncated or damaged: too little data for 8192 x 8192 pixels");
    EXPECT_TRUE(depth.empty());
}

}  // namespace
}  // namespace tessera
