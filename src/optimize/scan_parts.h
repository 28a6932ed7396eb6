// The parts of a scan. Where a lost camera is found nowhere, a new part begins: it is tracked and
// fused like the first, in the same map, but so far away that nothing of the two can meet. When the
// camera sees a place of another part, the two are joined.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapping/block_map.h"
#include "optimize/keyframe.h"
#include "optimize/pose_graph.h"

namespace tessera {

// In the map, between the starts of two parts.
inline constexpr double kPartsApart_m = 1000;
// After the first. More would be so far away that single precision shows.
inline constexpr int kMostParts = 24;
// A part with no more frames than that knows few places where the camera can be found.
inline constexpr int kShortPart = 10;

// Where the first camera of a part is in the map; 0 is the scan's first part.
inline Eigen::Isometry3d PartStart(int part) {
    constexpr int kInARow = 5;
    return Eigen::Isometry3d(Eigen::Translation3d(kPartsApart_m * (part % kInARow), 0,
                                                  kPartsApart_m * (part / kInARow)));
}

inline bool InOnePart(const Eigen::Isometry3d& T_map_a, const Eigen::Isometry3d& T_map_b) {
    return (T_map_a.translation() - T_map_b.translation()).norm() < kPartsApart_m / 2;
}

// Where a block is in the map.
inline Eigen::Isometry3d PlaceOf(const BlockCoord& c, const BlockMap::Config& map) {
    const double block_m = kBlockSide * map.voxel_size_m;
    return Eigen::Isometry3d(Eigen::Translation3d(block_m * Eigen::Vector3d(c.x, c.y, c.z)));
}
inline Eigen::Isometry3d PlaceOf(const BlockMap& map, BlockId id) {
    return PlaceOf(map.coord(id), map.config());
}

// Keyframes that edges join, directly or by way of others, are one part; and those that lie beside
// a part's first, should edges be missing. Returns for each keyframe the id of its part's first.
std::vector<int> PartsOf(std::span<const PoseEdge> edges, std::span<const Keyframe> keyframes);

// Which keyframes are left out of a whole scan: those outside the part with the most frames in the
// map. `parts`: as above; `frames`: by keyframe. Empty if there is only one part.
std::vector<bool> OutsideTheLargest(std::span<const int> parts, std::span<const int> frames);

// A keyframe of part (or scan) b that was found in part a.
struct CommonPlace {
    int in_a = 0, in_b = 0;            // the nearest keyframe of a, and the keyframe of b
    Eigen::Isometry3d T_in_a_in_b;     // relative pose of the two cameras
    Eigen::Isometry3d T_world_a_in_b;  // according to a's pose graph
};

// The largest set of places that agree on where b lies in a.
struct JointPose {
    Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  // of the two worlds
    std::vector<CommonPlace> places;
};
// Empty unless two of these places share less than half of their view: one may be another room of
// the same kind.
std::optional<JointPose> AgreeOnPose(std::span<const CommonPlace> places,
                                     std::span<const Keyframe> keyframes_of_b);

}  // namespace tessera
