// The points of one depth image, every `step`-th pixel in both directions, as the hot loop reads
// them: one slot per sampled pixel, weight 0 where there is no depth. Slots are laid out row by
// row, so that neighbours in the array are neighbours in the image.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/frame_motion.h"
#include "mapping/prepared_frame.h"
#include "tracking/point_kernels.h"

namespace tessera {

// A point's weight: (1 m / depth)^exponent, at most that at nearest_m.
struct DepthWeight {
    double exponent = 0, nearest_m = kNearestWeighed_m;
};

// Every step-th pixel's; intensities only if they are to be read and the frame has any. The images
// stay the frame's.
PointArguments MakePointArguments(const PreparedFrame& frame, const PinholeCamera& camera,
                                  const FrameMotion& motion, int step, const DepthWeight& weight,
                                  bool intensities);

class FramePoints {
  public:
    // Points in the frame of the camera at the frame's instant, metres.
    void Build(const PreparedFrame& frame, const PinholeCamera& camera, const FrameMotion& motion,
               int step, const DepthWeight& depth_weight);
    // Reads the intensity of each point where the colour camera saw it at its own time; -1 where it
    // saw nothing.
    void SampleIntensity(const PreparedFrame& frame, const PinholeCamera& camera,
                         const FrameMotion& motion);

    // The slots alone, for whoever fills them elsewhere; `valid` of them have a point. What the
    // arrays hold is unspecified.
    void Lay(const PointArguments& arguments, std::int64_t valid);

    // Normals of the measured surface in the camera frame, unit, towards the camera, from
    // differences across radius_px pixels to each side ([D18] eq. 15 has radius 1, one-sided). A
    // point without one, at a depth edge or a hole, loses its weight.
    void EstimateNormals(const PreparedFrame& frame, const PinholeCamera& camera, int radius_px);

    int width() const { return width_; }    // slots per row, a multiple of kPointPadding
    int height() const { return height_; }  // rows
    int count() const { return width_ * height_; }
    int ImageRow(int row) const { return row * step_ + step_ / 2; }
    int step() const { return step_; }
    std::int64_t valid() const { return valid_; }

    std::vector<float> x, y, z, intensity, weight;
    std::vector<float> normal_x, normal_y, normal_z;  // of the last EstimateNormals

  private:
    int width_ = 0, height_ = 0, step_ = 1;
    std::int64_t valid_ = 0;
};

}  // namespace tessera
