// Compares two maps word by word.
#pragma once

#include <gtest/gtest.h>

#include "mapping/block_map.h"

namespace tessera::testing_support {

inline void ExpectSameMap(const BlockMap& map, const BlockMap& expected) {
    ASSERT_EQ(map.size(), expected.size());
    for (BlockId id = 1; id < map.size(); ++id) {
        ASSERT_EQ(map.coord(id), expected.coord(id)) << id;
        ASSERT_EQ(map.revision(id), expected.revision(id)) << id;
        for (int i = 0; i < kBlockVoxels; ++i) {
            ASSERT_EQ(map.field(id)[i], expected.field(id)[i]) << id << ", voxel " << i;
            ASSERT_EQ(map.weight(id)[i], expected.weight(id)[i]) << id << ", voxel " << i;
            ASSERT_EQ(map.colour(id)[i], expected.colour(id)[i]) << id << ", voxel " << i;
        }
    }
}

}  // namespace tessera::testing_support
