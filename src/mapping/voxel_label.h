// A voxel's object label and how votes change it. Host-device: plain functions on plain types.
#pragma once

#include <cstdint>

#include "core/host_device.h"

namespace tessera {

// [D18] eq. 1: the two classes with the most votes; the first is the voxel's class. All zero means
// no votes yet. Also stores the instance with the most votes.
struct VoxelLabel {
    std::uint8_t class_id[2];
    std::uint8_t count[2];
    std::uint16_t instance;  // 0 = none
    std::uint8_t instance_count;
    // The last class with many votes and twice as many as the second; 0 = none yet.
    std::uint8_t settled;
};
static_assert(sizeof(VoxelLabel) == 8);

// Background seen beside an object in a detection's box. Votes like a class of its own.
inline constexpr std::uint8_t kBackgroundClass = 255;
inline constexpr int kSettledVotes = 16, kSettledRatio = 2;
// With 2, a hundredth of the voxels of a cluttered desk flip where objects touch.
inline constexpr int kFlipRatio = 8;
inline constexpr int kLeastVotes = 2;  // minimum for a voxel to have a class

// Adds one vote. Counters stop at 255; from then on, a vote for one class decrements the other, so
// that old mistakes fade. A vote for a third class decrements the second until it can be replaced.
// A settled voxel changes from one object class to another only for more than kFlipRatio times as
// many votes. Returns true if this vote caused such a change ([D18] 4.3: that should not happen).
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

// The voxel's instance was joined into this one, or dropped (0).
TESSERA_HD void HoldInstance(std::uint16_t instance, VoxelLabel& v) {
    v.instance = instance;
    if (instance == 0) v.instance_count = 0;
}

// Adds one vote for an instance. Another instance, or 0, votes against the current one.
TESSERA_HD void VoteForInstance(std::uint16_t instance, VoxelLabel& v) {
    if (instance != 0 && (v.instance == instance || v.instance_count == 0)) {
        v.instance = instance;
        if (v.instance_count < 255) ++v.instance_count;
    } else if (v.instance_count > 0 && --v.instance_count == 0) {
        v.instance = 0;
    }
}

// The voxel's class; 0 if it has none or is background.
TESSERA_HD std::uint8_t ClassOf(const VoxelLabel& v) {
    return v.count[0] >= kLeastVotes && v.class_id[0] != kBackgroundClass ? v.class_id[0]
                                                                          : std::uint8_t{0};
}

}  // namespace tessera
