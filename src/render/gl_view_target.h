// The images into which a predicted view is drawn, and their read-back to CPU memory. Another
// attachment needs one more Image here and one more shader output.
#pragma once

#include <vector>

#include "core/status.h"
#include "mapping/predicted_view.h"

namespace tessera {

// Owner thread only, with the same OpenGL context current in every call and on destruction. A
// program that draws into it has the outputs
//   layout(location = 0) out vec4 surface;  // unit normal, camera frame; intensity or -1
//   layout(location = 1) out vec4 colour;
//   layout(location = 2) out uint label;  // with labels only
class GlViewTarget {
  public:
    explicit GlViewTarget(bool labels);
    ~GlViewTarget();
    GlViewTarget(const GlViewTarget&) = delete;
    GlViewTarget& operator=(const GlViewTarget&) = delete;

    // Creates empty images of this size and draws into them from now on. Fails if the driver cannot
    // create them.
    Status Begin(int width, int height);
    // Fills the view's four images. The depth buffer must have been drawn with ClipFromCamera of
    // the same range.
    void ReadBack(float near_m, float far_m, PredictedView& view);
    // With labels only: fills an image of the view's size, 0 where there is no surface.
    void ReadLabels(Image<std::uint16_t>& labels);

  private:
    enum Attachment { kSurface, kColour, kLabel, kDepth, kAttachments };
    Status Resize(int width, int height);

    const bool labels_;
    unsigned framebuffer_ = 0;
    unsigned images_[kAttachments] = {};
    int width_ = 0, height_ = 0;
    std::vector<float> surface_;        // 4 per pixel
    std::vector<std::uint8_t> colour_;  // 4 per pixel
};

}  // namespace tessera
