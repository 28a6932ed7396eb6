// The preset bylow2014 solves [B14] eq. 8: its normal equations against a slow, literal second
// implementation with three colour channels.
#include <gtest/gtest.h>

#include "system/paper_energy.h"

namespace tessera {
namespace {

using namespace testing_support;

// R, G and B of a voxel as stored: luma, and two chromas.
Eigen::Vector3d VoxelRgb(FieldWord field, ColourWord colour) {
    const double y = (static_cast<double>(field & 0xffff) - 1) / 65534,
                 cb = ((colour & 1023) - 512.0) / 1022, cr = ((colour >> 10 & 1023) - 512.0) / 1022;
    const double r = y + 1.402 * cr, b = y + 1.772 * cb;
    return {r, (y - 0.299 * r - 0.114 * b) / 0.587, b};
}

// psi and psi_RGB between voxels, eq. 4 and 5: (psi, R, G, B).
struct Sample {
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    bool known = true, coloured = true;
};
Sample Between(const BlockMap& map, const Eigen::Vector3d& p_world) {
    const Eigen::Vector3d q = p_world / map.config().voxel_size_m;
    const Eigen::Vector3d low = q.array().floor();
    Sample sum;
    for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3d corner = low + Eigen::Vector3d(c & 1, c >> 1 & 1, c >> 2);
        const int x = int(corner.x()), y = int(corner.y()), z = int(corner.z());
        const BlockId id = map.Find({x >> 3, y >> 3, z >> 3});
        const int at = (x & 7) + 8 * (y & 7) + 64 * (z & 7);
        const FieldWord field = map.field(id)[at];
        sum.known = sum.known && HasDistance(field);
        sum.coloured = sum.coloured && HasIntensity(field);
        const double share =
            (1 - std::abs(q.x() - x)) * (1 - std::abs(q.y() - y)) * (1 - std::abs(q.z() - z));
        const double psi = static_cast<std::int16_t>(field >> 16) / 32767.0;
        Eigen::Vector4d value;
        value << psi * map.config().truncation_m, VoxelRgb(field, map.colour(id)[at]);
        sum.value += share * value;
    }
    return sum;
}

// Keeps the first sums and the arguments that led to them.
struct FirstSdfSums : CpuSdfSums {
    std::optional<PoseSums> sums;
    SdfArguments arguments{};

    PoseSums Sum(const SdfArguments& a, int points) override {
        const PoseSums now = CpuSdfSums::Sum(a, points);
        if (!sums) sums = now, arguments = a;
        return now;
    }
};

TEST(Bylow2014, SolvesTheNormalEquationsOfEquation8) {
    const PresetMap world("bylow2014");
    const TrackersConfig& trackers = world.config.pipeline.trackers;
    FirstSdfSums ours;
    ResidualModel model(trackers.photometric);
    SdfTracker tracker(trackers.sdf, world.camera, TrackJudge(trackers.judge), model, true, &ours);
    EXPECT_EQ(tracker.Track(world.Input()).status, TrackStatus::kGood);
    ASSERT_TRUE(ours.sums);

    // Increments turn about the origin of the local frame, which is moved by this.
    const BlockMap& map = *world.map;
    const Eigen::Vector3d origin =
        map.config().voxel_size_m * kBlockSide *
        Eigen::Vector3d(ours.arguments.origin_block[0], ours.arguments.origin_block[1],
                        ours.arguments.origin_block[2]);
    const Eigen::Isometry3d T_world_camera = world.Start();
    const double sigma[3] = {0.299, 0.587, 0.114};  // eq. 7, squared
    Normal distances, colours;
    int points = 0, coloured = 0;
    for (int v = 0; v < world.camera.height; ++v)
        for (int u = 0; u < world.camera.width; ++u) {
            const double z = world.frame.depth_m(u, v);
            if (z < world.config.pipeline.frame.min_depth_m ||
                z > world.config.pipeline.frame.max_depth_m)
                continue;
            const Eigen::Vector3d x((u - world.camera.cx) * z / world.camera.fx,
                                    (v - world.camera.cy) * z / world.camera.fy, z);  // eq. 1
            const Eigen::Vector3d p = T_world_camera * x - origin;
            // The field after a small increment, and so its derivatives.
            const auto after = [&](const Vector6d& xi) {
                return Between(map, Se3Exp(xi) * p + origin);
            };
            const Sample here = after(Vector6d::Zero());
            Eigen::Matrix<double, 4, 6> jacobian;
            for (int k = 0; k < 6; ++k) {
                constexpr double kStep = 1e-7;
                jacobian.col(k) = (after(kStep * Vector6d::Unit(k)).value -
                                   after(-kStep * Vector6d::Unit(k)).value) /
                                  (2 * kStep);
            }
            if (!here.known) continue;
            ++points;
            distances.Add(jacobian.row(0), here.value(0), 1.0);
            if (!here.coloured) continue;
            ++coloured;
            const Rgb8 colour = world.frame.colour(u, v);
            const double image[3] = {colour.r / 255.0, colour.g / 255.0, colour.b / 255.0};
            for (int c = 0; c < 3; ++c)
                colours.Add(jacobian.row(1 + c), here.value(1 + c) - image[c], sigma[c]);
        }
    EXPECT_GT(points, 10000);
    EXPECT_EQ((*ours.sums)[SumLayout::kKnown], points);
    EXPECT_EQ((*ours.sums)[SumLayout::kColoured], coloured);
    ExpectEqual(DistanceTerm(*ours.sums), distances);
    ExpectEqual(IntensityTerm(*ours.sums, {.estimate_brightness = false}, 1, 0), colours);
    EXPECT_EQ(model.alpha(), 0.1);
}

}  // namespace
}  // namespace tessera
