// Points held against an image from elsewhere, in plain pointers and numbers: what icp's sums and
// the prealignment's share.
#pragma once

namespace tessera {

struct ViewArguments {
    // The image, row by row, and its camera, in whose frame the pose is sought.
    int width, height;
    float fx, fy, cx, cy;
    const float* depth;      // metres along z, 0 where nothing is
    const float* intensity;  // < 0 where there is none, or none to be trusted
    // p_view [m] = rotation * p_point [m] + translation.
    float rotation[9];
    float translation[3];
    // The points in the frame of their own camera, metres, padded to a multiple of kPointPadding.
    const float* x;
    const float* y;
    const float* z;
    const float* intensity_of_point;  // < 0 where there is none
};

}  // namespace tessera
