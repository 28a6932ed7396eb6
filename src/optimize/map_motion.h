// How the blocks of a map move when the keyframes from which it was fused do.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mapping/block_map.h"
#include "optimize/keyframes.h"

namespace tessera {

// The displacement of a block's centre with each keyframe that sees it, weighted like their depths
// in fusion, by 1 / z^2. The mean over those that see a surface there tells where that goes; if
// none does, over all. Where the keyframes move apart, the surface itself changes, and the spread
// over all tells by how much.
struct BlockMotion {
    static constexpr float kDoubtful_m = 1e6f;  // a spread: the block is not to be moved

    Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();  // mean
    float spread_m = 0;                                 // standard deviation, all axes together
    bool seen = false;  // by a keyframe, or it moves like the blocks beside it that are
};

// Returns one for each id of `map`. `camera`: of the frames. `T_new_keyframe`: where each keyframe,
// now at T_map_camera, will be. Thread-safe.
std::vector<BlockMotion> MotionOfBlocks(const BlockMap& map, const Keyframes& keyframes,
                                        const std::vector<Eigen::Isometry3d>& T_new_keyframe,
                                        const PinholeCamera& camera);

}  // namespace tessera
