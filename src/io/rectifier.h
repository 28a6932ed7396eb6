// Converts raw camera images to what the rest of the program uses: an ideal pinhole camera, colour
// registered to depth and as bright in the corners as in the middle, and depth in metres.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/image.h"
#include "io/brightening.h"
#include "io/colour_registration.h"

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

    // True if pixels move: a lens is to be corrected, or colour registered to depth.
    bool active() const { return !depth_source_.empty() || registration_.has_value(); }
    // Whether a lens has distortion that is corrected.
    bool corrects_lens() const { return corrects_lens_; }
    // The size that raw colour images must have.
    ImageSize colour_size() const;

    // `raw` has the calibration's size; the output is resized to it. Only for an evenly bright
    // image: Fill evens it out. The intrinsics do not change. Bilinear interpolation. Beyond the
    // edge of the raw image, its border pixels are replicated (depth marks these pixels as
    // unmeasured). Not for a calibration with a colour camera of its own.
    void Colour(const ColourImage& raw, ColourImage& rectified) const;
    // Takes the nearest pixel and never interpolates: a mean across a depth discontinuity is a
    // surface that does not exist. 0 outside the raw image. Metres = stored / depth_scale.
    void Depth(const Image<std::uint16_t>& raw, DepthImage& depth_m) const;
    // Converts both images into a frame. `raw_colour` is used up. Empty colour stays empty.
    void Fill(const Image<std::uint16_t>& raw_depth, ColourImage& raw_colour, Frame& frame);

  private:
    CameraCalibration calibration_;
    std::uint16_t invalid_depth_;
    // Index of the raw pixel for each pixel, -1 = outside. Empty if pixels do not move.
    std::vector<std::int32_t> depth_source_;
    struct ColourMaps;
    std::unique_ptr<ColourMaps> colour_maps_;
    std::optional<ColourRegistration> registration_;
    bool corrects_lens_ = false;
    std::optional<Brightening> brightening_;  // of raw colour; set by the constructor
};

}  // namespace tessera
