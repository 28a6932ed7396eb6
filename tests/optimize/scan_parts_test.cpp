#include "optimize/scan_parts.h"

#include <gtest/gtest.h>

#include <array>

namespace tessera {
namespace {

PoseEdge Edge(int from, int to) {
    PoseEdge edge;
    edge.from = from;
    edge.to = to;
    return edge;
}

// Each a kilometre from the last.
std::vector<Keyframe> Apart(int count) {
    std::vector<Keyframe> keyframes(static_cast<std::size_t>(count));
    for (int id = 0; id < count; ++id)
        keyframes[static_cast<std::size_t>(id)].T_world_camera = PartStart(id);
    return keyframes;
}

TEST(ScanParts, AreWhatEdgesJoin) {
    EXPECT_EQ(PartsOf({}, {}), std::vector<int>());
    EXPECT_EQ(PartsOf({}, Apart(3)), (std::vector{0, 1, 2}));
    const PoseEdge chain[] = {Edge(0, 1), Edge(1, 2), Edge(3, 4), Edge(4, 5)};
    EXPECT_EQ(PartsOf(chain, Apart(6)), (std::vector{0, 0, 0, 3, 3, 3}));
    // In any order and direction, and by way of a later keyframe.
    const PoseEdge joined[] = {Edge(5, 4), Edge(3, 5), Edge(1, 2), Edge(5, 1)};
    EXPECT_EQ(PartsOf(joined, Apart(6)), (std::vector{0, 1, 1, 1, 1, 1}));
}

// A scan that was repaired may lack some.
TEST(ScanParts, MissingEdgesMakeNoParts) {
    std::vector<Keyframe> keyframes = Apart(5);
    keyframes[3].T_world_camera = PartStart(1) * Eigen::Translation3d(20, 0, -30);
    const PoseEdge edge[] = {Edge(3, 4)};
    EXPECT_EQ(PartsOf(edge, keyframes), (std::vector{0, 1, 2, 1, 1}));
}

TEST(ScanParts, TheOneWithMostFramesIsKept) {
    EXPECT_TRUE(OutsideTheLargest({}, {}).empty());
    const int one[] = {0, 0, 0}, parts[] = {0, 1, 1, 0, 4}, frames[] = {3, 1, 5, 2, 5};
    EXPECT_TRUE(OutsideTheLargest(one, std::array{0, 0, 0}).empty());
    EXPECT_EQ(OutsideTheLargest(parts, frames), (std::vector{true, false, false, true, true}));
    EXPECT_EQ(OutsideTheLargest(parts, std::array{3, 1, 4, 2, 5}),
              (std::vector{false, true, true, false, true}))
        << "of equals the first";
}

TEST(ScanParts, BeginFarFromEachOther) {
    EXPECT_TRUE(PartStart(0).isApprox(Eigen::Isometry3d::Identity()));
    for (int a = 0; a <= kMostParts; ++a)
        for (int b = 0; b <= kMostParts; ++b)
            EXPECT_EQ(InOnePart(PartStart(a), PartStart(b)), a == b) << a << " " << b;
    // Single precision is then half a millimetre or less.
    for (int part = 0; part <= kMostParts; ++part)
        EXPECT_LE(PartStart(part).translation().lpNorm<Eigen::Infinity>(), 4096);
}

}  // namespace
}  // namespace tessera
