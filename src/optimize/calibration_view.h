// A keyframe's depth image, much reduced, as self-calibration reads it.
#pragma once

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

class CalibrationView {
  public:
    static constexpr int kReduction = 4;

    // Metres; cells without a clear depth are left out.
    explicit CalibrationView(const DepthImage& depth_m);
    // The camera that such an image is of.
    static PinholeCamera ViewOf(const PinholeCamera& camera);

    const DepthImage& depth_m() const { return depth_m_; }

  private:
    DepthImage depth_m_;
};

}  // namespace tessera
