// A frame made ready once for tracking and fusion: depth gated, colour as luma and chroma.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/camera.h"
#include "core/config.h"
#include "core/frame.h"
#include "mapping/moving_mask.h"

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

    // Heavily reduced: intensity averaged, depth sampled; -1 and 0 where missing.
    struct Reduced {
        Image<float> intensity;
        DepthImage depth_m;
    };

    int width = 0, height = 0;
    bool has_colour = false;
    // All three are empty where only a device has them (Device::Prepare), and the colours without
    // colour.
    DepthImage depth_m;                  // 0 where missing or out of range
    Image<float> intensity;              // [0, 1], smoothed
    Image<std::uint32_t> packed_colour;  // fusion_arguments.h; Y is `intensity`
    std::array<Reduced, 2> reduced;      // coarse to fine, from about 40 and 80 columns on
    std::int64_t valid_depth_pixels = 0;
    std::int64_t measured_pixels = 0;  // with any depth at all, in range or not
    double coherent_fraction = 0;  // of neighbouring valid pixels, those within 5 % of each other
    float nearest_m = 0, farthest_m = 0;  // of the valid pixels
    // What moves has no depth above; null: nothing does. The map's surface before gone_m, of the
    // image's size, is gone; empty: none is.
    std::shared_ptr<const MovingMask> moving;
    DepthImage gone_m;
    // Another number for each PrepareFrame of this process: whoever keeps copies of the images
    // tells by it whose they are.
    std::uint64_t identity = 0;
};

// How many pixels in a row PreparedFrame::reduced[level] makes one of, for images of that size. At
// least two rows are left, or all: one cannot read between less.
int ReductionOf(int width, int height, std::size_t level);

// Reuses the storage of `prepared`. What `moving` marks, if given, has no depth.
void PrepareFrame(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& prepared,
                  const MovingMask* moving = nullptr);
// The same with other marks, for a frame that is prepared already: its colour stays.
void PrepareDepthAgain(const Frame& frame, const PreparedFrame::Config& config,
                       PreparedFrame& prepared, const MovingMask* moving);
// Enters a mask into a frame that was prepared without the depth of what moves.
void SetMoving(std::shared_ptr<const MovingMask> moving, PreparedFrame& prepared);

// What it leaves besides images, of a frame's pixels.
struct FrameCounts {
    std::int64_t valid = 0, measured = 0;
    std::int64_t pairs = 0, coherent = 0;  // of pixels side by side
    float nearest_m = 1e9f, farthest_m = 0;
};
// Size, colour or none, counts and a new identity; nothing moves.
void SetFacts(int width, int height, bool has_colour, const FrameCounts& counts,
              PreparedFrame& prepared);

}  // namespace tessera
