// Makes small recordings as the app Record3D writes them.
#pragma once

#include <gtest/gtest.h>
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "io/jpeg_encoder.h"
#include "recordings/lzfse_encoder.h"

namespace tessera {

using ZipFiles = std::map<std::string, std::vector<std::uint8_t>>;  // by name

inline void WriteZip(const std::string& path, const ZipFiles& files) {
    std::filesystem::remove(path);
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE, nullptr);
    ASSERT_NE(archive, nullptr);
    for (const auto& [name, bytes] : files) {
        zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
        const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE);
        ASSERT_GE(index, 0) << name;
        zip_set_file_compression(archive, static_cast<zip_uint64_t>(index),
                                 name.ends_with(".jpg") ? ZIP_CM_STORE : ZIP_CM_DEFLATE, 0);
    }
    ASSERT_EQ(zip_close(archive), 0);
}

// The start of the metadata, to be ended with "}".
inline const std::string kRecord3dCamera =
    R"({"w": 48, "h": 64, "K": [50, 0, 0, 0, 52, 0, 23, 33, 1], "fps": 20)";
inline const std::string kRecord3dDepthSize = R"(, "dw": 12, "dh": 16)";
inline constexpr int kRecord3dWidth = 48, kRecord3dHeight = 64;            // of colour
inline constexpr int kRecord3dDepthWidth = 12, kRecord3dDepthHeight = 16;  // pixels
inline constexpr int kRecord3dPixels = kRecord3dDepthWidth * kRecord3dDepthHeight;

template <typename Number>
std::vector<std::uint8_t> LzfseOf(const std::vector<Number>& numbers, LzfseBlock kind) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(numbers.data());
    return EncodeLzfse({raw, numbers.size() * sizeof(Number)}, {kind});
}

// In metres. The first five pixels are no measurement.
inline float Record3dDepthOf(int frame, int pixel) {
    constexpr float kNone[] = {std::numeric_limits<float>::quiet_NaN(), -1.f, 6.51f, 0.f,
                               std::numeric_limits<float>::infinity()};
    if (pixel < 5) return kNone[pixel];
    return 0.5f + static_cast<float>(frame) + 0.005f * static_cast<float>(pixel);
}
inline std::uint8_t Record3dConfidenceOf(int pixel) { return static_cast<std::uint8_t>(pixel % 3); }
inline Rgb8 Record3dColourOf(int frame) {
    return {static_cast<std::uint8_t>(20 * frame), 100, 200};
}

inline std::vector<std::uint8_t> Record3dJpegOf(int frame, int width, int height) {
    std::vector<std::uint8_t> file;
    EXPECT_TRUE(EncodeJpeg(ColourImage(width, height, Record3dColourOf(frame)), 95, file).ok());
    return file;
}

// The files of frame `frame` under the name `number`.
inline void AddRecord3dFrame(int number, int frame, LzfseBlock kind, ZipFiles& files) {
    std::vector<float> depth_m;
    std::vector<std::uint8_t> confidence;
    for (int i = 0; i < kRecord3dPixels; ++i) {
        depth_m.push_back(Record3dDepthOf(frame, i));
        confidence.push_back(Record3dConfidenceOf(i));
    }
    const std::string name = "rgbd/" + std::to_string(number);
    files[name + ".jpg"] = Record3dJpegOf(frame, kRecord3dWidth, kRecord3dHeight);
    files[name + ".depth"] = LzfseOf(depth_m, kind);
    files[name + ".conf"] = LzfseOf(confidence, kind);
}

}  // namespace tessera
