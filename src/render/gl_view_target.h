// The images that a predicted view is drawn into, and their way back to the processor's memory. One
// more attachment (labels, say) is one more Image here and one more output of the shader.
#pragma once

#include <vector>

#include "core/status.h"
#include "mapping/predicted_view.h"

namespace tessera {

// Owner thread only, with the same OpenGL context current in every call and when it is destroyed. A
// program that draws into it has the outputs
//   layout(location = 0) out vec4 surface;  // unit normal in the camera frame; intensity in [0,
//   1], -1: none layout(location = 1) out vec4 colour;
class GlViewTarget {
  public:
    GlViewTarget();
    ~GlViewTarget();
    GlViewTarget(const GlViewTarget&) = delete;
    GlViewTarget& operator=(const GlViewTarget&) = delete;

    // Empty images of this size, and all that is drawn goes there. Fails where the driver cannot
    // make them.
    Status Begin(int width, int height);
    // Fills the view's four images. The depth buffer must have been drawn with ClipFromCamera of
    // the same range.
    void ReadBack(float near_m, float far_m, PredictedView& view);

  private:
    enum Image { kSurface, kColour, kDepth, kImages };
    Status Resize(int width, int height);

    unsigned framebuffer_ = 0;
    unsigned images_[kImages] = {};
    int width_ = 0, height_ = 0;
    std::vector<float> surface_;        // 4 a pixel
    std::vector<std::uint8_t> colour_;  // 4 a pixel
};

}  // namespace tessera
