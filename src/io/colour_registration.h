// Brings colour images into the depth camera's view: another image size, another lens, or another
// place beside it. The depth stays as it was measured.
#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "core/status.h"
#include "io/image_header.h"

namespace tessera {

// Keeps its buffers between images. Owner thread only.
class ColourRegistration {
  public:
    // `depth_camera`: of the depth images after rectification.
    ColourRegistration(const ColourCamera& colour, const PinholeCamera& depth_camera);

    // The size that raw colour images must have.
    ImageSize raw_size() const { return raw_size_; }

    // Samples `raw_colour`, an image of the colour camera with its distortion, for each pixel of
    // `depth_m`. Depth that the colour camera does not see is removed. Where nothing was measured,
    // the depth of the pixel to the left is assumed. What only the depth camera sees behind an
    // edge gets the colour of what hides it.
    void Register(const ColourImage& raw_colour, DepthImage& depth_m, ColourImage& colour);

  private:
    const ColourImage& Shrunk(const ColourImage& raw_colour);
    void RegisterRow(const ColourImage& source, int y, float* depth_m, Rgb8* colour) const;

    ImageSize raw_size_;
    PinholeCamera depth_camera_, colour_camera_;  // the latter of the shrunk images
    LensDistortion distortion_;
    Eigen::Isometry3d T_colour_depth_;
    int shrink_ = 1;  // one pixel of the shrunk image is this many pixels wide
    ColourImage shrunk_;
};

// Lets the colour of each depth pixel be taken `shift_px` depth pixels farther right and down. A
// colour camera of its own is turned, about the same centre; else one is added.
void MoveColour(const Eigen::Vector2d& shift_px, CameraCalibration& calibration);

// An error if the colour images have another size than depth, for formats in which they cannot.
Status CheckOneSize(const CameraCalibration& calibration);

}  // namespace tessera
