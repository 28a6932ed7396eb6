// The points of one depth image, at every `step`-th pixel in both directions, as the hot loop reads
// them: one slot per sampled pixel, weight 0 where there is no depth. Slots are stored row by row,
// so that neighbours in the array are neighbours in the image.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/frame_motion.h"
#include "mapping/prepared_frame.h"
#include "tracking/point_kernels.h"

namespace tessera {

// What PointWeight needs besides the depth.
struct DepthWeight {
    double noise_depth_m = 0, nearest_m = kMinWeightDepth_m;
};

// The pixel step of the finest level: `configured`, or for 0 the one at which an image has about as
// many points as one of 640 x 480 pixels at the step `at_vga_px`, but at least 2. At most half of
// the image.
int FinestStep(int configured, int at_vga_px, const PinholeCamera& camera);

// The number of levels, at least 1: `configured`, or as many as leave the coarsest image 6 pixels
// wide and high. Each level doubles the step.
int LevelsThatFit(int configured, int finest_step_px, const PinholeCamera& camera);

// Arguments for every step-th pixel. Includes intensities, and chroma besides, only if requested
// and if the frame has colour. Refers to the frame's images.
PointArguments MakePointArguments(const PreparedFrame& frame, const PinholeCamera& camera,
                                  const FrameMotion& motion, int step, const DepthWeight& weight,
                                  bool intensities, bool chroma = false);

class FramePoints {
  public:
    // Builds points in the camera frame at the frame's timestamp, metres, and what the arguments
    // ask for besides:
    // - Normals of the measured surface, in the camera frame, unit, towards the camera, from
    //   differences across normal_radius_px pixels (NormalAt). A point at a depth discontinuity or
    //   hole has no normal and loses its weight.
    // - The intensity of each point where the colour camera saw it, at that camera's own time; -1
    //   where it saw nothing, and without intensities. Chroma in the units of voxel.h, where there
    //   is an intensity.
    void Build(const PointArguments& arguments);

    // Only lays out the slots, for points that are filled in elsewhere; `valid` of them have a
    // point. The contents of the arrays are unspecified.
    void Allocate(const PointArguments& arguments, std::int64_t valid);

    int width() const { return width_; }    // slots per row, a multiple of kPointPadding
    int height() const { return height_; }  // rows
    int count() const { return width_ * height_; }
    int ImageRow(int row) const { return row * step_ + step_ / 2; }
    int step() const { return step_; }
    std::int64_t valid() const { return valid_; }

    std::vector<float> x, y, z, intensity, weight;
    std::vector<float> normal_x, normal_y, normal_z;  // if asked for, as are these:
    std::vector<float> cb, cr;

  private:
    void BuildRows(const PointArguments& arguments);
    void EstimateNormals(const PointArguments& arguments);
    void SampleColour(const PointArguments& arguments);

    int width_ = 0, height_ = 0, step_ = 1;
    std::int64_t valid_ = 0;
};

}  // namespace tessera
