// Evidence for each tile from a frame, the frames before it, the map and a detector. MovingDetector
// decides by it.
#pragma once

#include <deque>
#include <vector>

#include "tracking/moving_detector.h"
#include "tracking/tile_view.h"

namespace tessera {

inline constexpr int kMapQueryStride =
    2;  // one in this many tiles per row or column queries the map

// Differences between a frame and the earlier ones.
struct DepthChanges {
    Image<std::uint8_t> came;   // stands in former free space
    DepthImage left_m;          // depth of what has left, where it was
    Image<std::uint8_t> there;  // matches a surface seen one window ago
    bool any = false;
};

// What the frame and the map's view say about each tile.
struct MovingEvidence {
    Image<std::uint8_t> candidates;  // may move
    Image<std::uint8_t> seeds;       // candidates that changed
    Image<std::uint8_t> growing;     // move if they touch something that moves
    Image<std::uint8_t> gone;        // the frame sees through the map's surface
    bool fits = false;               // the rest fits the map
};

struct MovingHistory {
    TileView now;
    std::deque<TileView> past;   // oldest first
    Image<std::uint8_t> moving;  // in `now`; empty if nothing moves
    // Between frames that follow each other: how many times, and the sum.
    int intervals = 0;
    double intervals_s = 0;
    TileView hint;             // depth where a detector marks something as moving; empty if nowhere
    bool hint_placed = false;  // its pose is known

    DepthImage CarriedHint(double stamp_s, const Eigen::Isometry3d& T_world_camera,
                           const PinholeCamera& camera, double window_s) const;
};

// Compares one frame with the remembered ones.
class MovingAnalysis {
  public:
    MovingAnalysis(const MovingDetector::Config& config, const PinholeCamera& camera,
                   MovingHistory& memory)
        : config_(config),
          camera_(camera),
          margin_{static_cast<float>(config.margin_m), static_cast<float>(config.margin_per_m)},
          memory_(memory) {}

    void Ingest(const MovingDetector::Input& input, int step, const BlockMap& map);
    DepthChanges Compare() const;
    MovingEvidence Evaluate(const DepthChanges& changes, const DepthImage& hinted_m,
                            const BlockMap& map, const DepthImage& predicted_m) const;
    void Decide(MovingEvidence& evidence);

  private:
    std::vector<const TileView*> ToCompare() const;
    bool IsOld(const TileView& view) const;
    bool MapHadIt(int x, int y, const BlockMap& map) const;
    int Blur(double turned_rad, double since_s) const;

    const MovingDetector::Config& config_;
    const PinholeCamera& camera_;
    DepthMargin margin_;
    MovingHistory& memory_;
};

}  // namespace tessera
