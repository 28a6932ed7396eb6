// A keyframe's depth image at reduced resolution, for self-calibration.
#pragma once

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

class CalibrationView {
  public:
    static constexpr int kReduction = 4;

    // In metres. Cells without a clear depth are 0.
    explicit CalibrationView(const DepthImage& depth_m);
    // Returns the camera of the reduced image.
    static PinholeCamera ViewOf(const PinholeCamera& camera);

    const DepthImage& depth_m() const { return depth_m_; }

  private:
    DepthImage depth_m_;
};

}  // namespace tessera
