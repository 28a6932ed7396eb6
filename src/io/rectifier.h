// Converts raw camera images to what the rest of the program uses: an ideal pinhole camera and
// depth in metres. Each image takes one pass over precomputed tables.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/image.h"

namespace tessera {

// Owner thread only.
class Rectifier {
  public:
    struct Options {
        bool correct_distortion = true;   // false: the lens's distortion stays in the images
        std::uint16_t invalid_depth = 0;  // a stored value that means "no measurement", besides 0
    };

    Rectifier(const CameraCalibration& calibration, const Options& options);
    ~Rectifier();
    Rectifier(Rectifier&&) noexcept;
    Rectifier& operator=(Rectifier&&) noexcept;

    // True if pixels move: the calibration has distortion and it is to be corrected.
    bool active() const { return !depth_source_.empty(); }

    // `raw` has the calibration's size; the output is resized to it. The intrinsics do not change.
    // Bilinear interpolation. Beyond the edge of the raw image, its border pixels are replicated
    // (depth marks these pixels as unmeasured).
    void Colour(const ColourImage& raw, ColourImage& rectified) const;
    // Takes the nearest pixel and never interpolates: a mean across a depth discontinuity is a
    // surface that does not exist. 0 outside the raw image. Metres = stored / depth_scale.
    void Depth(const Image<std::uint16_t>& raw, DepthImage& depth_m) const;
    // Converts both images into a frame. If active() is false, `raw_colour` is swapped with the
    // frame's colour image. Empty colour stays empty.
    void Fill(const Image<std::uint16_t>& raw_depth, ColourImage& raw_colour, Frame& frame) const;

  private:
    CameraCalibration calibration_;
    std::uint16_t invalid_depth_;
    // Index of the raw pixel for each pixel, -1 = outside. Empty if pixels do not move.
    std::vector<std::int32_t> depth_source_;
    struct ColourMaps;
    std::unique_ptr<ColourMaps> colour_maps_;
};

}  // namespace tessera
