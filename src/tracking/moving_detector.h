// Finds moving objects in a tracked frame: what stands where an earlier frame of the last second
// saw free space, and what is connected to it in front of the map's surface. docs/moving.md has the
// rule and its reasons.
#pragma once

#include <memory>
#include <optional>

#include "core/config.h"
#include "mapping/moving_mask.h"
#include "mapping/predicted_view.h"

namespace tessera {

struct MovingHistory;

// Owner thread only; uses TBB internally and gives the same result for any number of threads.
class MovingDetector {
  public:
    struct Config {
        bool enabled = true;
        double window_s = 1.0;
        double margin_m = 0.04;
        double margin_per_m = 0.01;
        double min_area_m2 = 0.02;
        double min_changed_fraction = 0.15;
        double min_fitting_fraction = 0.5;

        void Describe(ConfigParameters& parameters);
    };

    // The detector's input besides the map.
    struct Input {
        const DepthImage& depth_m;         // as measured by the camera
        float disparity_offset_per_m = 0;  // for the correction of depth_m
        float farthest_m = 5;              // the map holds nothing beyond
        double stamp_s = 0;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    };

    MovingDetector(const Config& config, const PinholeCamera& camera);
    ~MovingDetector();

    // Returns null if nothing moves and no surface of the map has disappeared. Queries the map,
    // through `predictor`, only where two frames differ.
    std::shared_ptr<const MovingMask> Find(const Input& input, const BlockMap& map,
                                           ViewPredictor& predictor);
    // The moving regions of the previous frame, as seen by a camera at this pose, with a margin.
    // Tracking must skip them. Null if there are none.
    std::shared_ptr<const MovingMask> PredictMask(double stamp_s,
                                                  const Eigen::Isometry3d& T_world_camera) const;

    // Takes a detector's hint. What it marks counts as moving, even if it stands still, until the
    // window is over or the next hint arrives. The hint is for the next frame given to PredictMask
    // and Find, or for an earlier frame that was tracked to T_world_camera.
    void SetHint(const MovingHint& hint, float disparity_offset_per_m,
                 const std::optional<Eigen::Isometry3d>& T_world_camera);

    // Call this when the map is moved, and the camera with it.
    void Move(const Eigen::Isometry3d& T_new_old);
    // Forgets the last second. Call this when the camera's pose is unrelated to its earlier ones.
    void Clear();

  private:
    Config config_;
    int step_;
    PinholeCamera camera_;  // of the tile images
    std::unique_ptr<MovingHistory> memory_;
};

}  // namespace tessera
