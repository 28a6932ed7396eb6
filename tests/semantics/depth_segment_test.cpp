// A box on a table, seen at an angle, with exact and with noisy depth.
#include "semantics/depth_segment.h"

#include <gtest/gtest.h>

#include <random>

#include "semantics/label_votes.h"

namespace tessera {
namespace {

const PinholeCamera kCamera{160, 120, 131.0, 131.0, 79.5, 59.5};

struct View {
    DepthImage depth_m{160, 120, 0.0f};
    Image<std::uint8_t> object{160, 120, 0};
    PixelBox box{160, 120, 0, 0};
};

// The camera looks down at 45 degrees onto the plane y' = 0.7 (y' down). A box of 20 x 10 x 20 cm
// stands on it.
View TableAndBox(double noise_m) {
    View view;
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 1);
    // Camera to world.
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(-M_PI / 4, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const Eigen::Vector3d low(-0.1, 0.6, 0.6), high(0.1, 0.7, 0.8);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const Eigen::Vector3d ray = R * kCamera.Unproject(x, y, 1);
            double t = 1e9;
            if (ray.y() > 0) t = 0.7 / ray.y();
            const Eigen::Array3d a = low.array() / ray.array(), b = high.array() / ray.array();
            const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
            const bool hit = enter < leave && enter > 0 && enter < t - 1e-9;
            if (hit) t = enter;
            if (t > 5) continue;
            view.depth_m(x, y) = static_cast<float>(t + noise_m * noise(random));
            view.object(x, y) = hit;
            if (!hit) continue;
            view.box = {std::min(view.box.x_begin, x), std::min(view.box.y_begin, y),
                        std::max(view.box.x_end, x + 1), std::max(view.box.y_end, y + 1)};
        }
    return view;
}

double Iou(const View& view, const Image<std::uint8_t>& mask) {
    int both = 0, any = 0;
    for (int y = 0; y < view.box.height(); ++y)
        for (int x = 0; x < view.box.width(); ++x) {
            const bool is = view.object(x + view.box.x_begin, y + view.box.y_begin) != 0,
                       said = mask(x, y) != 0;
            both += is && said, any += is || said;
        }
    return both / static_cast<double>(any);
}

TEST(DepthSegment, TheTableIsLeftOut) {
    for (const double noise_m : {0.0, 0.001}) {
        const View view = TableAndBox(noise_m);
        ASSERT_GT(view.box.width(), 20);
        Image<std::uint8_t> mask;
        SegmentByDepth(view.depth_m, kCamera, view.box, {}, mask);
        EXPECT_GT(Iou(view, mask), 0.88) << noise_m;
        const double segment = Iou(view, mask);
        SegmentByMeanDepth(view.depth_m, view.box, mask);
        EXPECT_GT(segment, Iou(view, mask) + 0.1) << noise_m;  // the rule used in the paper
    }
}

TEST(DepthSegment, WhatIsFlatOnItsSupportIsTheWholeBox) {
    View view;
    std::fill_n(view.depth_m.data(), view.depth_m.size(), 1.0f);
    view.box = {50, 40, 90, 80};
    Image<std::uint8_t> mask;
    SegmentByDepth(view.depth_m, kCamera, view.box, {}, mask);
    EXPECT_EQ(std::count(mask.data(), mask.data() + mask.size(), 1), 1600);
}

TEST(DepthSegment, NothingMeasuredIsNothing) {
    DepthImage empty(160, 120, 0.0f);
    Image<std::uint8_t> mask;
    SegmentByDepth(empty, kCamera, {0, 0, 160, 120}, {}, mask);
    EXPECT_EQ(std::count(mask.data(), mask.data() + mask.size(), 1), 0);
    SegmentByMeanDepth(empty, {150, 110, 160, 120}, mask);
    EXPECT_EQ(std::count(mask.data(), mask.data() + mask.size(), 1), 0);
}

TEST(MeanDepth, DeeperThanTheMeanIsBackground) {
    DepthImage depth(4, 1);
    depth(0, 0) = 1, depth(1, 0) = 2, depth(2, 0) = 0, depth(3, 0) = 6;  // mean 3
    Image<std::uint8_t> mask;
    SegmentByMeanDepth(depth, {0, 0, 4, 1}, mask);
    EXPECT_EQ(mask(0, 0), 1);
    EXPECT_EQ(mask(1, 0), 1);
    EXPECT_EQ(mask(2, 0), 0);
    EXPECT_EQ(mask(3, 0), 0);
}

const BlockMap::Config kVoxels{.voxel_size_m = 0.01, .truncation_m = 0.04};

// A wall at 1 m.
void MakeWall(BlockMap& map) {
    map.EnableLabels();
    for (int bx = -2; bx < 2; ++bx)
        for (int by = -2; by < 2; ++by)
            for (int bz = 11; bz < 14; ++bz) {
                const BlockId id = map.Allocate({bx, by, bz});
                for (int i = 0; i < kBlockVoxels; ++i) {
                    const double distance =
                        std::clamp(1.0 - 0.01 * (8 * bz + (i >> 6)), -0.04, 0.04);
                    map.field(id)[i] = static_cast<std::uint32_t>(static_cast<std::uint16_t>(
                                           std::lround(distance / 0.04 * 32767)))
                                       << 16;
                }
            }
}

const Image<std::uint8_t> kNothing(160, 120, 0);

// Exactly the voxels within the truncation band get one vote each.
TEST(VoteLabels, OnlyTheBandAroundTheSurface) {
    BlockMap map(kVoxels);
    MakeWall(map);
    DepthImage depth(160, 120, 1.0f);
    LabelImage labels{kNothing, kNothing};
    for (int y = 50; y < 70; ++y)
        for (int x = 70; x < 90; ++x) labels.detection(x, y) = 1;
    const Ballot ballot{5, 3};
    const VoteCount count = VoteLabels(labels, {&ballot, 1}, {}, depth, kCamera,
                                       Eigen::Isometry3d::Identity(), 0.0151, map);
    std::int64_t voxels = 0;
    std::vector<BlockId> expected_blocks;
    for (BlockId id = 1; id < map.size(); ++id)
        for (int i = 0; i < kBlockVoxels; ++i) {
            const VoxelLabel& v = map.label(id)[i];
            const BlockCoord c = map.coord(id);
            const int z = 8 * c.z + (i >> 6);
            const Eigen::Vector2d pixel = kCamera.Project(
                0.01 * Eigen::Vector3d(8.0 * c.x + (i & 7), 8.0 * c.y + (i >> 3 & 7), z));
            const long px = std::lround(pixel.x()), py = std::lround(pixel.y());
            const bool expected =
                std::abs(z - 100) <= 1 && px >= 70 && px < 90 && py >= 50 && py < 70;
            EXPECT_EQ(v.count[0], expected) << z << " " << px << " " << py;
            EXPECT_EQ(v.instance, expected ? 3 : 0);
            voxels += expected;
            if (expected && (expected_blocks.empty() || expected_blocks.back() != id))
                expected_blocks.push_back(id);
        }
    EXPECT_EQ(count.blocks, expected_blocks);
    EXPECT_EQ(count.voxels, voxels);
    EXPECT_GT(voxels, 500);
}

// A wall of whose pixels each has a first and a second claim on the ballots.
struct ClaimedWall {
    ClaimedWall() { MakeWall(map); }
    // Casts the same claims for all pixels, and returns the instance of a voxel in the middle.
    std::uint16_t Vote(int times, std::uint8_t first, std::uint8_t second,
                       const std::vector<Ballot>& ballots) {
        const LabelImage labels{Image<std::uint8_t>(160, 120, first),
                                Image<std::uint8_t>(160, 120, second)};
        for (int i = 0; i < times; ++i)
            VoteLabels(labels, ballots, holders, DepthImage(160, 120, 1.0f), kCamera,
                       Eigen::Isometry3d::Identity(), 0.0151, map);
        return voxel().instance;
    }
    const VoxelLabel& voxel() { return map.label(map.Find({0, 0, 12}))[4 * 64]; }

    BlockMap map{kVoxels};
    std::vector<Holder> holders{{}, {1}, {2}, {3}};
};

TEST(VoteLabels, AVoxelsHolderCounts) {
    ClaimedWall wall;
    const VoxelLabel& voxel = wall.voxel();
    const auto vote = [&](int times, std::uint8_t first, std::uint8_t second,
                          const std::vector<Ballot>& ballots) {
        return wall.Vote(times, first, second, ballots);
    };
    EXPECT_EQ(vote(6, 1, 0, {{5, 1}, {5, 2}}), 1);
    // Claimed by 2, which covers the undetected 1: no change.
    EXPECT_EQ(vote(20, 2, 0, {{}, {5, 2, true, {1}}}), 1);
    EXPECT_EQ(voxel.instance_count, 6);
    EXPECT_EQ(voxel.count[0], 6);
    // Claimed by both: the vote goes to the instance that holds the voxel, if the other one has
    // voxels of its own.
    EXPECT_EQ(vote(20, 2, 1, {{5, 1, true}, {5, 2, true}}), 1);
    EXPECT_EQ(voxel.instance_count, 26);
    // Claimed by 2 alone while 1 is seen elsewhere: three votes each. If 1 is not seen at all: one
    // vote.
    EXPECT_EQ(vote(8, 2, 0, {{5, 1, true}, {5, 2, true}}), 1);
    EXPECT_EQ(voxel.instance_count, 2);
    EXPECT_EQ(vote(1, 2, 0, {{}, {5, 2, true}}), 1);
    EXPECT_EQ(vote(1, 2, 0, {{}, {5, 2, true}}), 0);
    EXPECT_EQ(vote(1, 2, 1, {{5, 1, true}, {5, 2}}), 2);
}

// The pixels lie in the box of a detection, but not on its object.
TEST(VoteLabels, AMissedObjectInTheBoxOfAnotherKeepsItsVoxels) {
    ClaimedWall wall;
    constexpr std::uint8_t kBeside = LabelImage::kBesideObjects;
    EXPECT_EQ(wall.Vote(6, 1, 0, {{5, 1}}), 1);
    wall.holders[1].stands = true;
    EXPECT_EQ(wall.Vote(20, kBeside, 0, {{4, 2}}), 1);
    EXPECT_EQ(wall.voxel().instance_count, 6);
    EXPECT_EQ(wall.voxel().count[0], 6);
    EXPECT_EQ(wall.voxel().count[1], 0);
    // What the object's own mask does not have is cleaned, as is what no longer stands.
    EXPECT_EQ(wall.Vote(1, kBeside, 0, {{5, 1}}), 1);
    EXPECT_EQ(wall.voxel().instance_count, 5);
    EXPECT_EQ(wall.voxel().count[1], 1);
    wall.holders[1].stands = false;
    EXPECT_EQ(wall.Vote(5, kBeside, 0, {{4, 2}}), 0);
    EXPECT_EQ(wall.voxel().count[1], 6);
}

TEST(VoteLabels, VotesAfterAJoinCountForTheVoxelsOfBoth) {
    ClaimedWall wall;
    EXPECT_EQ(wall.Vote(6, 1, 0, {{5, 1}}), 1);
    wall.holders[1] = {2};
    EXPECT_EQ(wall.Vote(3, 1, 0, {{5, 2}}), 2);
    EXPECT_EQ(wall.voxel().instance_count, 9);
    wall.holders[1] = wall.holders[2] = {};  // dropped
    EXPECT_EQ(wall.Vote(1, 1, 0, {{5, 3}}), 3);
    EXPECT_EQ(wall.voxel().instance_count, 1);
}

}  // namespace
}  // namespace tessera
