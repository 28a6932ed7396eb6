// Images and logs of images.
#include <fcntl.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "fuzz/fuzz_target.h"
#include "io/image_decoder.h"
#include "io/klg_source.h"
#include "io/pipe_source.h"

namespace tessera::fuzz {
namespace {

Bytes Encoded(const std::string& extension, int type, const std::vector<int>& how = {}) {
    cv::Mat pixels(11, 14, type);
    for (std::size_t i = 0; i < pixels.total() * pixels.elemSize(); ++i)
        pixels.data[i] = static_cast<std::uint8_t>(37 * i + i * i / 11);
    Bytes file;
    cv::imencode(extension, pixels, file, how);
    return file;
}

void PutBigEndian(std::uint32_t value, std::uint8_t* to) {
    for (int shift = 24; shift >= 0; shift -= 8) *to++ = static_cast<std::uint8_t>(value >> shift);
}

// Decodes as colour and as depth; what is decoded has the size of its header.
void Decode(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    ImageDecoder decoder;
    const Result<ImageSize> size = decoder.Load(file.path());
    CheckError(size.status(), file.path());
    // What a camera's size would refuse takes only time here.
    if (!size.ok() || std::int64_t{size.value().width} * size.value().height > 1 << 20) return;
    const auto check = [&](const Status& status, const auto& image) {
        CheckError(status, file.path());
        TESSERA_CHECK(!status.ok() || (image.width() == size.value().width &&
                                       image.height() == size.value().height),
                      "{} x {} pixels decoded", image.width(), image.height());
    };
    ColourImage colour;
    check(decoder.DecodeColour(colour), colour);
    Image<std::uint16_t> depth;
    check(decoder.DecodeDepth(depth), depth);
}

// The checksums of a mutated PNG are made right, or nothing behind them would be reached.
void DecodePng(std::span<const std::uint8_t> bytes) {
    Bytes file(bytes.begin(), bytes.end());
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t length = std::size_t{file[at]} << 24 | std::size_t{file[at + 1]} << 16 |
                                   std::size_t{file[at + 2]} << 8 | file[at + 3];
        if (length > file.size() - at - 12) break;
        PutBigEndian(libdeflate_crc32(0, &file[at + 4], length + 4), &file[at + 8 + length]);
        at += length + 12;
    }
    Decode(file);
}

// Width, height, bit depth and colour type, then the rows: the rows' own filters are fuzzed.
void DecodePngRows(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 5) return;
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const auto chunk = [&](const char* type, std::span<const std::uint8_t> data) {
        const std::size_t at = file.size();
        file.resize(at + 12 + data.size());
        PutBigEndian(static_cast<std::uint32_t>(data.size()), &file[at]);
        std::memcpy(&file[at + 4], type, 4);
        std::copy(data.begin(), data.end(), file.begin() + static_cast<std::ptrdiff_t>(at) + 8);
    };
    Bytes header(13, 0);
    header[3] = bytes[0];
    header[7] = bytes[1];
    std::copy_n(bytes.begin() + 2, 2, header.begin() + 8);
    header[12] = bytes[4] & 1;
    chunk("IHDR", header);
    libdeflate_compressor* packer = libdeflate_alloc_compressor(1);
    const auto rows = bytes.subspan(5);
    Bytes packed(libdeflate_zlib_compress_bound(packer, rows.size()));
    packed.resize(
        libdeflate_zlib_compress(packer, rows.data(), rows.size(), packed.data(), packed.size()));
    libdeflate_free_compressor(packer);
    chunk("IDAT", packed);
    chunk("IEND", {});
    DecodePng(file);
}

template <class Number>
void Append(Bytes& bytes, Number number) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
    bytes.insert(bytes.end(), begin, begin + sizeof(number));
}

// A log of three frames, packed as far as it goes: 640 x 480 pixels without a camera.yaml.
Bytes SomeLog() {
    const Bytes depth(std::size_t{640} * 480 * 2, 3), colour = [] {
        Bytes file;
        cv::imencode(".jpg", cv::Mat(480, 640, CV_8UC3, cv::Scalar(1, 2, 3)), file);
        return file;
    }();
    libdeflate_compressor* packer = libdeflate_alloc_compressor(9);
    Bytes packed(libdeflate_zlib_compress_bound(packer, depth.size()));
    packed.resize(
        libdeflate_zlib_compress(packer, depth.data(), depth.size(), packed.data(), packed.size()));
    libdeflate_free_compressor(packer);
    Bytes log;
    Append(log, std::int32_t{3});
    for (std::int64_t i = 0; i < 3; ++i) {
        Append(log, 1000 + 33333 * i);
        Append(log, static_cast<std::int32_t>(packed.size()));
        Append(log, static_cast<std::int32_t>(colour.size()));
        log.insert(log.end(), packed.begin(), packed.end());
        log.insert(log.end(), colour.begin(), colour.end());
    }
    return log;
}

void ReadLog(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const auto source = OpenKlgSource(file.path(), {});
    CheckError(source.status(), file.path());
    if (!source.ok()) return;
    Frame frame;
    double last_s = -1e300;
    for (int i = 0; i < 20; ++i) {
        const ReadResult read = source.value()->Read(frame);
        if (read.status == ReadStatus::kEnd) break;
        if (read.status != ReadStatus::kOk) continue;
        TESSERA_CHECK(frame.stamp_s > last_s, "{} follows {}", frame.stamp_s, last_s);
        last_s = frame.stamp_s;
    }
}

// A camera and two frames, one of them compressed.
Bytes SomeStream() {
    const std::string camera = "width: 16\nheight: 12\nfx: 15\nfy: 15\ncx: 8\ncy: 6\n";
    Bytes stream = BytesOf("TESSERA1");
    Append(stream, static_cast<std::uint32_t>(camera.size()));
    stream.insert(stream.end(), camera.begin(), camera.end());
    const Bytes depth(16 * 12 * 2, 3), colour(16 * 12 * 3, 5), jpeg = [] {
        Bytes file;
        cv::imencode(".jpg", cv::Mat(12, 16, CV_8UC3, cv::Scalar(1, 2, 3)), file);
        return file;
    }();
    std::int64_t stamp_us = 0;
    for (const Bytes* second : {&colour, &jpeg}) {
        Append(stream, stamp_us += 33333);
        Append(stream, static_cast<std::int32_t>(depth.size()));
        Append(stream, static_cast<std::int32_t>(second->size()));
        stream.insert(stream.end(), depth.begin(), depth.end());
        stream.insert(stream.end(), second->begin(), second->end());
    }
    return stream;
}

void ReadStream(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const auto source =
        OpenPipeSource("pipe:x", ByteStream(open(file.path().c_str(), O_RDONLY)), {}, 1);
    CheckError(source.status(), "pipe:x");
    if (!source.ok()) return;
    const PinholeCamera& camera = source.value()->info().camera;
    Frame frame;
    for (ReadResult read; read.status != ReadStatus::kEnd; read = source.value()->Read(frame)) {
        TESSERA_CHECK(read.status != ReadStatus::kWait, "waits for a file");
        if (read.status == ReadStatus::kSkip) CheckError(Status::Error(read.message), "pipe:x");
        TESSERA_CHECK(frame.depth_m.empty() || frame.depth_m.width() == camera.width,
                      "{} pixels wide", frame.depth_m.width());
    }
}

}  // namespace

std::vector<FuzzTarget> ImageTargets() {
    return {
        {"png",
         [] {
             return std::vector<Bytes>{Encoded(".png", CV_16UC1), Encoded(".png", CV_8UC3),
                                       Encoded(".png", CV_8UC1), Encoded(".png", CV_8UC4),
                                       Encoded(".png", CV_16UC3)};
         },
         DecodePng},
        {"png_rows",
         [] {
             std::vector<Bytes> seeds;
             for (const auto& [type, row] :
                  {std::pair{0, 1 + 2 * 7}, {2, 1 + 3 * 7}, {6, 1 + 4 * 7}}) {
                 const int bits = type == 0 ? 16 : 8;
                 Bytes seed = {7, 5, static_cast<std::uint8_t>(bits),
                               static_cast<std::uint8_t>(type), 0};
                 for (int i = 0; i < 5 * row; ++i)
                     seed.push_back(static_cast<std::uint8_t>(i % row == 0 ? i / row : 7 * i));
                 seeds.push_back(seed);
             }
             return seeds;
         },
         DecodePngRows},
        {"jpeg",
         [] {
             return std::vector<Bytes>{Encoded(".jpg", CV_8UC3), Encoded(".jpg", CV_8UC1),
                                       Encoded(".jpg", CV_8UC3, {cv::IMWRITE_JPEG_PROGRESSIVE, 1})};
         },
         Decode},
        {"other_images",
         [] {
             return std::vector<Bytes>{Encoded(".tiff", CV_16UC1), Encoded(".tiff", CV_8UC3),
                                       Encoded(".bmp", CV_8UC3), Encoded(".pgm", CV_16UC1),
                                       Encoded(".ppm", CV_8UC3)};
         },
         Decode},
        {"klg", [] { return std::vector<Bytes>{SomeLog()}; }, ReadLog, 300},
        {"pipe", [] { return std::vector<Bytes>{SomeStream()}; }, ReadStream, 1000},
    };
}

}  // namespace tessera::fuzz
