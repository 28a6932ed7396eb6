// Points compared with an image from another pose, as plain pointers and numbers. Shared by the ICP
// sums and the prealignment's.
#pragma once

namespace tessera {

struct ViewArguments {
    // The image, row by row, and its camera. The pose is estimated in this camera's frame.
    int width, height;
    float fx, fy, cx, cy;
    const float* depth;      // metres along z, 0 where there is no surface
    const float* intensity;  // < 0 where there is none, or an unreliable one
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
