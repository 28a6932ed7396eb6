// Turns detections into votes of voxels ([D18] eq. 1), using the pose and depth of the detected
// frame even if the detector finishes later.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/camera.h"
#include "mapping/block_map.h"
#include "semantics/label_image.h"

namespace tessera {

// What the pixels of a detection vote for.
struct Ballot {
    std::uint8_t class_id = 0;   // 0: no vote
    std::uint16_t instance = 0;  // 0: against any instance
    bool shown = false;          // the map shows that instance
    // Instances covered by the detection that were not detected themselves. They keep their voxels.
    std::vector<std::uint16_t> covered = {};
};

// What a voxel means that holds an instance number.
struct Holder {
    std::uint16_t instance = 0;  // that the number was joined into, or itself; 0: dropped
    bool stands = false;         // Instances::stands
};

struct VoteCount {
    std::int64_t voxels = 0;  // that got a vote
    std::int64_t flips = 0;   // settled voxels whose class changed (voxel_label.h)
    // Voxels that newly settled on an object class.
    std::int64_t settled = 0;
    std::vector<BlockId> blocks = {};  // that hold these voxels, increasing
};

// Adds one vote to each voxel whose stored distance is at most `band_m` and that the frame sees: it
// must project to a labelled pixel whose depth is within the truncation distance. `ballots`: one
// per detection. Pixels beside objects vote for the background, unless the voxel holds an instance
// that stands and was not detected. A pixel claimed by two detections votes for the one whose
// instance the voxel holds. `holders`: by instance number. A voxel that gets a vote then holds the
// current number. The map must have labels; no voxels are created. Uses all cores (TBB); the result
// does not depend on their number. Map's owner thread only.
VoteCount VoteLabels(const LabelImage& labels, std::span<const Ballot> ballots,
                     std::span<const Holder> holders, const DepthImage& depth_m,
                     const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                     double band_m, BlockMap& map);

}  // namespace tessera
