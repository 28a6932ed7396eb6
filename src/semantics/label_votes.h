// Detections become votes of voxels ([D18] eq. 1): from the pose and depth of the frame that was
// detected, however late the detector answered.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/camera.h"
#include "mapping/block_map.h"
#include "semantics/label_image.h"

namespace tessera {

// What a detection's pixels vote for.
struct Ballot {
    std::uint8_t class_id = 0;   // 0: no vote
    std::uint16_t instance = 0;  // 0: against whatever there is
    bool shown = false;          // the map shows that instance
    // Instances within the detection that were not detected: they keep their voxels.
    std::vector<std::uint16_t> covered = {};
};

struct VoteCount {
    std::int64_t voxels = 0;  // that got a vote
    std::int64_t flips = 0;   // settled voxels that changed their class (voxel_label.h)
    // Voxels that settled on an object's class, having been settled on none.
    std::int64_t settled = 0;
    std::vector<BlockId> blocks = {};  // of those voxels, increasing
};

// One vote for each voxel whose stored distance is at most `band_m` from the surface and that the
// frame sees: it projects to a pixel with a label and measured depth within the map's truncation.
// `ballots`: one a detection; pixels beside objects vote for the background. A pixel that two
// detections claim votes for the one whose instance the voxel holds. `joined`: what each instance's
// number stands for now. The map must have labels; no voxel is made. Uses all cores (TBB), the same
// result for any number. The map's owner only.
VoteCount VoteLabels(const LabelImage& labels, std::span<const Ballot> ballots,
                     std::span<const std::uint16_t> joined, const DepthImage& depth_m,
                     const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                     double band_m, BlockMap& map);

}  // namespace tessera
