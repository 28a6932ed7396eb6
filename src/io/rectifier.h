// Raw images of a real camera to what the rest of the program sees: an ideal pinhole and depth in
// metres, in one pass per image over tables made once.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/image.h"

namespace tessera {

// Owner thread only (the tables are read-only, but OpenCV sees the images).
class Rectifier {
  public:
    struct Options {
        bool correct_distortion = true;   // false: the lens's distortion stays in the images
        std::uint16_t invalid_depth = 0;  // a stored value that means "no measurement", beside 0
    };

    Rectifier(const CameraCalibration& calibration, const Options& options);
    ~Rectifier();
    Rectifier(Rectifier&&) noexcept;
    Rectifier& operator=(Rectifier&&) noexcept;

    // Whether pixels move: the calibration has distortion and it is to be corrected.
    bool active() const { return !depth_source_.empty(); }

    // Both images have the calibration's size; the output is resized to it. The pinhole stays the
    // calibration's. Bilinear; beyond the raw image's edge its border pixels go on (depth says that
    // nothing was seen there).
    void Colour(const ColourImage& raw, ColourImage& rectified) const;
    // Nearest pixel, never mixed: a mean across an edge is a surface that does not exist. 0 where
    // the raw image has nothing. Metres = stored / depth_scale.
    void Depth(const Image<std::uint16_t>& raw, DepthImage& depth_m) const;
    // Both into a frame; where nothing moves, `raw_colour` is swapped with the frame's. An empty
    // one stays empty.
    void Fill(const Image<std::uint16_t>& raw_depth, ColourImage& raw_colour, Frame& frame) const;

  private:
    CameraCalibration calibration_;
    std::uint16_t invalid_depth_;
    std::vector<std::int32_t>
        depth_source_;  // per pixel the raw pixel's index, -1 = outside; empty: no change
    struct ColourMaps;
    std::unique_ptr<ColourMaps> colour_maps_;
};

}  // namespace tessera
