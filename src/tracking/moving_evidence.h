// What a frame and the moments before it, the map and a detector say of each tile: the evidence
// that MovingDetector decides by.
#pragma once

#include <deque>
#include <vector>

#include "tracking/moving_detector.h"
#include "tracking/tile_view.h"

namespace tessera {

inline constexpr int kAskedTiles = 2;  // of so many in a row or column the map is asked at one

// What differs between a frame and the moments before.
struct MovingChanges {
    Image<std::uint8_t> came;   // stands in what was free space
    DepthImage left_m;          // how far what left had been, where it had been
    Image<std::uint8_t> there;  // stands where a surface was seen a window ago
    bool any = false;
};

// What the frame and the map's view say about each tile.
struct MovingEvidence {
    Image<std::uint8_t> candidates;  // may move
    Image<std::uint8_t> seeds;       // of them, those that changed
    Image<std::uint8_t> growing;     // hang together with what moves, if they touch it
    Image<std::uint8_t> gone;        // the map's surface is seen through
    bool fits = false;               // the rest fits the map
};

struct MovingMemory {
    TileView now;
    std::deque<TileView> past;   // oldest first
    Image<std::uint8_t> moving;  // in `now`; empty: nothing
    TileView hint;               // depth where a detector says that something moves; empty: nowhere

    DepthImage CarriedHint(double stamp_s, const Eigen::Isometry3d& T_world_camera,
                           const PinholeCamera& camera, double window_s) const;
};

// One frame against what is remembered.
class MovingMoments {
  public:
    MovingMoments(const MovingDetector::Config& config, const PinholeCamera& camera,
                  MovingMemory& memory)
        : config_(config),
          camera_(camera),
          margin_{static_cast<float>(config.margin_m), static_cast<float>(config.margin_per_m)},
          memory_(memory) {}

    void Take(const MovingDetector::Input& input, int step);
    MovingChanges Compare() const;
    MovingEvidence Weigh(const MovingChanges& changes, const DepthImage& hinted_m,
                         const DepthImage& predicted_m) const;
    void Decide(MovingEvidence& evidence);

  private:
    std::vector<const TileView*> ToCompare() const;
    int Blur(double turned_rad, double since_s) const;

    const MovingDetector::Config& config_;
    const PinholeCamera& camera_;
    DepthMargin margin_;
    MovingMemory& memory_;
};

}  // namespace tessera
