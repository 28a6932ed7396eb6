// A frame made ready once for tracking and fusion: depth gated, colour as luma and chroma.
#pragma once

#include <cstdint>

#include "core/camera.h"
#include "core/config.h"
#include "core/frame.h"

namespace tessera {

struct PreparedFrame {
    struct Config {
        double min_depth_m = 0.3;
        double max_depth_m = 5.0;
        int intensity_blur_px = 1;
        double min_coherent_fraction = 0.5;
        double disparity_offset_per_m = 0;

        void Describe(ConfigParameters& parameters);
        Status Validate() const;
    };

    DepthImage depth_m;                // 0 where missing or out of range
    Image<float> intensity;            // [0, 1], smoothed; empty if the frame has no colour
    Image<std::uint32_t> packed_colour;  // fusion_arguments.h; Y is `intensity`
    std::int64_t valid_depth_pixels = 0;
    std::int64_t measured_pixels = 0;  // with any depth at all, in range or not
    double coherent_fraction = 0;  // of neighbouring valid pixels, those within 5 % of each other
    float nearest_m = 0, farthest_m = 0;  // of the valid pixels
    // Another number for each PrepareFrame of this process: whoever keeps copies of the images tells by it whose they are.
    std::uint64_t identity = 0;

    bool has_colour() const { return !intensity.empty(); }
};

// Reuses the storage of `prepared`.
void PrepareFrame(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& prepared);

}  // namespace tessera
