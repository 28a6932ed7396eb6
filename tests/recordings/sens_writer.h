// Writes .sens files for tests. Made from the published description of the format
// (github.com/ScanNet/ScanNet, SensReader), independently of the reader.
#pragma once

#include <libdeflate.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/image.h"
#include "io/jpeg_encoder.h"
#include "io/png_encoder.h"

namespace tessera {

using SensTestMatrix = Eigen::Matrix4f;

struct SensTestFrame {
    std::uint64_t colour_stamp_us = 0, depth_stamp_us = 0;
    std::string colour, depth;  // as stored
};

struct SensTestFile {
    std::uint32_t version = 4;
    std::string sensor = "StructureSensor";
    SensTestMatrix colour_intrinsic = Intrinsic(70, 71, 31.5f, 23.25f);
    SensTestMatrix colour_extrinsic = SensTestMatrix::Identity();
    SensTestMatrix depth_intrinsic = Intrinsic(36, 37, 15.25f, 11.5f);
    SensTestMatrix depth_extrinsic = SensTestMatrix::Identity();
    std::int32_t colour_kind = 2, depth_kind = 1;
    std::uint32_t colour_width = 64, colour_height = 48, depth_width = 32, depth_height = 24;
    float depth_shift = 1000;
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();  // that: the number of frames
    std::vector<SensTestFrame> frames;

    static SensTestMatrix Intrinsic(float fx, float fy, float cx, float cy) {
        SensTestMatrix k = SensTestMatrix::Identity();
        k(0, 0) = fx;
        k(1, 1) = fy;
        k(0, 2) = cx;
        k(1, 2) = cy;
        return k;
    }

    std::string Bytes() const {
        std::string out;
        Put(out, version);
        Put(out, std::uint64_t{sensor.size()});
        out += sensor;
        for (const SensTestMatrix* m :
             {&colour_intrinsic, &colour_extrinsic, &depth_intrinsic, &depth_extrinsic})
            PutRows(out, *m);
        Put(out, colour_kind);
        Put(out, depth_kind);
        for (const std::uint32_t side : {colour_width, colour_height, depth_width, depth_height})
            Put(out, side);
        Put(out, depth_shift);
        const bool counted = count == std::numeric_limits<std::uint64_t>::max();
        Put(out, counted ? std::uint64_t{frames.size()} : count);
        for (const SensTestFrame& frame : frames) PutFrame(out, frame);
        Put(out, std::uint64_t{0});  // measurements of motion
        return out;
    }

    template <class Value>
    static void Put(std::string& out, Value value) {
        out.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    static void PutRows(std::string& out, const SensTestMatrix& m) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) Put(out, m(row, column));
    }
    static void PutFrame(std::string& out, const SensTestFrame& frame) {
        PutRows(out, SensTestMatrix::Identity());  // camera to world
        Put(out, frame.colour_stamp_us);
        Put(out, frame.depth_stamp_us);
        Put(out, std::uint64_t{frame.colour.size()});
        Put(out, std::uint64_t{frame.depth.size()});
        out += frame.colour + frame.depth;
    }
};

inline std::string SensTestRaw(const Image<std::uint16_t>& depth) {
    return {reinterpret_cast<const char*>(depth.data()), 2 * depth.size()};
}

inline std::string SensTestRaw(const ColourImage& colour) {
    return {reinterpret_cast<const char*>(colour.data()), 3 * colour.size()};
}

inline std::string SensTestZlib(const Image<std::uint16_t>& depth) {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    const std::string raw = SensTestRaw(depth);
    std::string packed(libdeflate_zlib_compress_bound(compressor, raw.size()), '\0');
    packed.resize(
        libdeflate_zlib_compress(compressor, raw.data(), raw.size(), packed.data(), packed.size()));
    libdeflate_free_compressor(compressor);
    return packed;
}

inline std::string SensTestPng(const ColourImage& colour) {
    std::vector<std::uint8_t> file;
    PngEncoder().EncodeColour(colour, file);
    return {file.begin(), file.end()};
}

inline std::string SensTestJpeg(const ColourImage& colour) {
    std::vector<std::uint8_t> file;
    return EncodeJpeg(colour, 95, file).ok() ? std::string(file.begin(), file.end()) : "";
}

}  // namespace tessera
