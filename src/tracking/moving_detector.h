// Finds what moves in a frame that was tracked: what stands where another moment of the last second
// saw free space, and what hangs together with it before the map's surface. docs/moving.md has the
// rule and its reasons.
#pragma once

#include <memory>
#include <optional>

#include "core/config.h"
#include "mapping/moving_mask.h"
#include "mapping/predicted_view.h"

namespace tessera {

struct MovingMemory;

// Owner thread only; TBB inside, the same result for any number of threads.
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

    // What the detector is told besides the map.
    struct Input {
        const DepthImage& depth_m;         // as the camera gave it
        float disparity_offset_per_m = 0;  // to correct it by
        float farthest_m = 5;              // the map holds nothing beyond
        double stamp_s = 0;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    };

    MovingDetector(const Config& config, const PinholeCamera& camera);
    ~MovingDetector();

    // Null: nothing moves, and nothing of the map has gone. The map is asked, by `predictor`, only
    // where two moments differ.
    std::shared_ptr<const MovingMask> Find(const Input& input, const BlockMap& map,
                                           ViewPredictor& predictor);
    // What was found to move in the frame before, where a camera there would see it, and somewhat
    // around: not to be tracked on. Null: nothing.
    std::shared_ptr<const MovingMask> Expect(double stamp_s,
                                             const Eigen::Isometry3d& T_world_camera) const;

    // What a detector says: it moves, however still it stands, until the window is over or the next
    // hint comes. Of the frame that is given to Expect and Find next, or of an earlier one, which
    // was tracked to T_world_camera.
    void Guide(const MovingHint& hint, float disparity_offset_per_m,
               const std::optional<Eigen::Isometry3d>& T_world_camera);

    // The map was moved, the camera with it.
    void Move(const Eigen::Isometry3d& T_new_old);
    // Forgets the last second: where the camera is now says nothing of where it was.
    void Clear();

  private:
    Config config_;
    int step_;
    PinholeCamera camera_;  // the tiles'
    std::unique_ptr<MovingMemory> memory_;
};

}  // namespace tessera
