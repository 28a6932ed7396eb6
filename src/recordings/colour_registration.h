// Brings colour images into the depth camera's view: another image size, another lens, or another
// place beside it. The depth stays as it was measured.
#pragma once

#include "core/image.h"
#include "recordings/recording.h"

namespace tessera {

// Keeps its buffers between images. Owner thread only.
class ColourRegistration {
  public:
    // The cameras of `info`. `depth_camera`: of the depth images after rectification.
    ColourRegistration(const RecordingInfo& info, const PinholeCamera& depth_camera);

    // Samples `raw_colour`, an image of the colour camera with its distortion, for each pixel of
    // `depth_m`. Depth that the colour camera does not see is removed. Where nothing was measured,
    // the depth of the pixel to the left is assumed. What only the depth camera sees behind an
    // edge gets the colour of what hides it.
    void Register(const ColourImage& raw_colour, DepthImage& depth_m, ColourImage& colour);

  private:
    const ColourImage& Shrunk(const ColourImage& raw_colour);

    PinholeCamera depth_camera_, colour_camera_;  // the latter of the shrunk images
    LensDistortion distortion_;
    Eigen::Isometry3d T_colour_depth_;
    int shrink_ = 1;  // one pixel of the shrunk image is this many pixels wide
    ColourImage shrunk_;
};

// Whether both images are of one camera and size, so that nothing needs to be registered.
bool IsRegistered(const RecordingInfo& info);

}  // namespace tessera
