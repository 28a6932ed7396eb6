// A frame prepared once for tracking and fusion: depth gated, colour as luma and chroma.
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

    // Strongly reduced images. Intensity is averaged, -1 where missing; depth is sampled, 0 where
    // missing.
    struct Reduced {
        Image<float> intensity;
        DepthImage depth_m;
    };

    int width = 0, height = 0;
    bool has_colour = false;
    // All three are empty if only a device has them (Device::Prepare). The last two are also empty
    // for a frame without colour.
    DepthImage depth_m;                  // 0 where missing or out of range
    Image<float> intensity;              // [0, 1], smoothed
    Image<std::uint32_t> packed_colour;  // fusion_arguments.h; Y is `intensity`
    std::array<Reduced, 2> reduced;      // coarse to fine, at least about 40 and 80 columns
    std::int64_t valid_depth_pixels = 0;
    std::int64_t measured_pixels = 0;  // pixels with any depth, in range or not
    double coherent_fraction = 0;      // fraction of adjacent valid pixels within 5 % of each other
    float nearest_m = 0, farthest_m = 0;  // over the valid pixels
    // During a run: the largest depth that the user wants in the map, for this frame; 0: as
    // configured.
    double limit_m = 0;
    // Moving pixels have no depth above; null if nothing moves. Map surfaces nearer than gone_m
    // (same size as the image) have disappeared; empty if none has.
    std::shared_ptr<const MovingMask> moving;
    DepthImage gone_m;
    // Unique per PrepareFrame call in this process. Holders of copied images use it to recognise
    // the frame.
    std::uint64_t identity = 0;
};

// The tile side, in pixels, that PreparedFrame::reduced[level] reduces to one pixel for images of
// this size. At least two rows remain, or all of them, because interpolation needs two.
int ReductionOf(int width, int height, std::size_t level);

// Reuses the storage of `prepared`. Pixels that `moving` marks, if given, get no depth.
void PrepareFrame(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& prepared,
                  const MovingMask* moving = nullptr);
// The same with another mask, for a frame that is prepared already. Keeps its colour.
void RemaskDepth(const Frame& frame, const PreparedFrame::Config& config, PreparedFrame& prepared,
                 const MovingMask* moving);
// As if the frame had no colour.
void ForgetColour(PreparedFrame& prepared);
// Attaches a mask to a frame that was prepared without the depth of moving pixels.
void SetMoving(std::shared_ptr<const MovingMask> moving, PreparedFrame& prepared);

// The frame without the depth that is not to be in the map: of moving pixels, and beyond limit_m
// where that is less than the configured limit.
Frame WithoutLeftOut(const Frame& frame, const PreparedFrame& prepared,
                     const PreparedFrame::Config& config);

// Statistics of a frame's pixels that preparation computes besides the images.
struct FrameCounts {
    std::int64_t valid = 0, measured = 0;
    std::int64_t pairs = 0, coherent = 0;  // of adjacent pixels
    float nearest_m = 1e9f, farthest_m = 0;
};
// Sets size, colour flag and counts, assigns a new identity and clears the moving mask.
void SetFacts(int width, int height, bool has_colour, const FrameCounts& counts,
              PreparedFrame& prepared);

}  // namespace tessera
