// What a voxel knows of objects, and how it is told. Host-device: plain functions on plain types.
#pragma once

#include <cstdint>

#include "core/host_device.h"

namespace tessera {

// [D18] eq. 1: the two classes with the most votes, the first the one that counts; all zero: none
// yet. Also the instance most voted for.
struct VoxelLabel {
    std::uint8_t class_id[2];
    std::uint8_t count[2];
    std::uint16_t instance;  // 0 = none
    std::uint8_t instance_count;
    // The class that once had many votes and twice as many as the second; 0 = none yet.
    std::uint8_t settled;
};
static_assert(sizeof(VoxelLabel) == 8);

// Seen beside an object, in a detection's box: a class of its own among the votes.
inline constexpr std::uint8_t kBackgroundClass = 255;
inline constexpr int kSettledVotes = 16, kSettledRatio = 2;
// With 2, a hundredth of a cluttered desk's voxels flip, where objects touch.
inline constexpr int kFlipRatio = 8;
inline constexpr int kLeastVotes = 2;  // for a voxel to have a class

// One vote. Counters stop at 255; there a vote for the one takes from the other, so that old
// mistakes fade. A third class wears the second out before it takes its place. A settled voxel goes
// from one kind of object to another only for kFlipRatio times as many votes. True if it did by
// this vote ([D18] 4.3: that should not happen).
TESSERA_HD bool VoteForClass(std::uint8_t class_id, VoxelLabel& v) {
    bool flipped = false;
    if (v.count[0] == 0 || v.class_id[0] == class_id) {
        v.class_id[0] = class_id;
        if (v.count[0] < 255)
            ++v.count[0];
        else if (v.count[1] > 0)
            --v.count[1];
    } else if (v.count[1] == 0 || v.class_id[1] == class_id) {
        v.class_id[1] = class_id;
        if (v.count[1] < 255)
            ++v.count[1];
        else
            --v.count[0];
        const bool settled = v.settled == v.class_id[0] && v.settled != kBackgroundClass &&
                             v.class_id[1] != kBackgroundClass;
        if (v.count[1] > (settled ? kFlipRatio : 1) * v.count[0]) {
            flipped = settled;
            const std::uint8_t old_class = v.class_id[0], old_count = v.count[0];
            v.class_id[0] = v.class_id[1];
            v.count[0] = v.count[1];
            v.class_id[1] = old_class;
            v.count[1] = old_count;
        }
    } else {
        --v.count[1];
    }
    if (v.count[0] >= kSettledVotes && v.count[0] >= kSettledRatio * v.count[1])
        v.settled = v.class_id[0];
    return flipped;
}

// One vote for an instance, or with 0 against the one there is.
TESSERA_HD void VoteForInstance(std::uint16_t instance, VoxelLabel& v) {
    if (instance != 0 && (v.instance == instance || v.instance_count == 0)) {
        v.instance = instance;
        if (v.instance_count < 255) ++v.instance_count;
    } else if (v.instance_count > 0 && --v.instance_count == 0) {
        v.instance = 0;
    }
}

// The class, 0 if it has none or is background.
TESSERA_HD std::uint8_t ClassOf(const VoxelLabel& v) {
    return v.count[0] >= kLeastVotes && v.class_id[0] != kBackgroundClass ? v.class_id[0]
                                                                          : std::uint8_t{0};
}

}  // namespace tessera
