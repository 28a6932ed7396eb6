// Finds what moves in a frame that was tracked: what stands where another moment of the last second saw free space, and what
// hangs together with it before the map's surface. docs/moving.md has the rule and its reasons.
#pragma once

#include <deque>
#include <memory>

#include "core/config.h"
#include "mapping/moving_mask.h"
#include "mapping/predicted_view.h"
#include "tracking/tile_view.h"

namespace tessera {

// Owner thread only.
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
        const DepthImage& depth_m;          // as the camera gave it
        float disparity_offset_per_m = 0;   // to correct it by
        float farthest_m = 5;               // the map holds nothing beyond
        double stamp_s = 0;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    };

    MovingDetector(const Config& config, const PinholeCamera& camera);

    // Null: nothing moves, and nothing of the map has gone. The map is asked, by `predictor`, only where two moments differ.
    std::shared_ptr<const MovingMask> Find(const Input& input, const BlockMap& map, ViewPredictor& predictor);

    // What was found to move in the frame before, where a camera there would see it, and somewhat around: not to be tracked on.
    // Null: nothing.
    std::shared_ptr<const MovingMask> Expect(double stamp_s, const Eigen::Isometry3d& T_world_camera) const;

    // The map was moved, the camera with it.
    void Move(const Eigen::Isometry3d& T_new_old);
    // Forgets the last second: where the camera is now says nothing of where it was.
    void Clear() {
        past_.clear();
        found_.reset();
    }

  private:
    struct Changes;
    int ReachOf(const Input& input) const;
    bool FindChanges(Changes& changes) const;
    std::vector<const TileView*> Moments() const;
    void Remember();
    std::shared_ptr<const MovingMask> Judge(const Changes& changes, const DepthImage& predicted_m) const;

    Config config_;
    DepthMargin margin_;
    int step_;
    PinholeCamera camera_;        // the tiles'
    TileView now_;
    std::deque<TileView> past_;   // oldest first
    std::shared_ptr<const MovingMask> found_;  // in now_
    PredictedView predicted_;
};

}  // namespace tessera
