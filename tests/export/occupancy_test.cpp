#include "export/occupancy.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapping/analytic_fields.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::SmallCamera;

// A room with a ball, mapped completely and exactly, in which cameras look at the ball.
class Occupancies : public ::testing::Test {
  protected:
    static constexpr double kVoxel_m = 0.02, kTruncation_m = 0.06, kCell_m = 0.05;

    Occupancies() {
        room.has_ball = true;
        testing_support::Fill(map,
                              [this](const Eigen::Vector3d& p) { return room.SignedDistance(p); },
                              {-12, -8, -8}, {11, 8, 15});
        T_world_grid.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -2, 1).normalized()));
        for (int i = 0; i < 6; ++i) path.push_back({0.1 * i, testing_support::SmoothPath(10 * i)});
        const Eigen::AlignedBox3d box(Eigen::Vector3d(-2, -1.5, -1.5),
                                      Eigen::Vector3d(2, 1.5, 2.5));
        grid = MakeGrid(box, kCell_m, T_world_grid).value();
    }

    Occupancy Make(const Occupancy::Options& options = {}) const {
        return MakeOccupancy(map, grid, SmallCamera(), path, options).value();
    }
    template <class Visit>
    void ForEachCell(const Visit& visit) const {
        for (int z = 0; z < grid.size.z(); ++z)
            for (int y = 0; y < grid.size.y(); ++y)
                for (int x = 0; x < grid.size.x(); ++x)
                    visit(grid.Index(x, y, z), T_world_grid * grid.Centre(x, y, z));
    }
    // How far in front of the surface along its ray a camera sees the point, metres along the
    // optical axis, shrunk by `border_px` on each side of the image; negative if it does not.
    double InFront(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& p,
                   double border_px) const {
        const PinholeCamera c = SmallCamera();
        const Eigen::Vector3d q = T_world_camera.inverse() * p;
        if (q.z() <= 0) return -1;
        const Eigen::Vector2d u = c.Project(q);
        if (u.minCoeff() < border_px || u.x() > c.width - 1 - border_px ||
            u.y() > c.height - 1 - border_px)
            return -1;
        const Eigen::Vector3d eye = T_world_camera.translation();
        return (room.Cast(eye, p - eye) - 1) * q.z();
    }
    bool NearSilhouette(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& p) const {
        const Eigen::Vector3d eye = T_world_camera.translation(), ray = (p - eye).normalized(),
                              to_ball = room.ball_centre - eye;
        return std::abs(to_ball.cross(ray).norm() - room.ball_radius_m) < 0.06;
    }

    testing_support::BoxRoom room;
    BlockMap map{BlockMap::Config{.voxel_size_m = kVoxel_m, .truncation_m = kTruncation_m}};
    Eigen::Isometry3d T_world_grid = Eigen::Isometry3d::Identity();
    CellGrid grid;
    std::vector<StampedPose> path;
};

TEST_F(Occupancies, CellsWithSurfaceAreOccupiedAndNoOthers) {
    const Occupancy occupancy = Make();
    const double half_m = kCell_m / 2;
    int occupied = 0;
    ForEachCell([&](std::size_t i, const Eigen::Vector3d& p) {
        double low = 1e9, high = -1e9;
        for (int c = 0; c < 8; ++c) {
            const Eigen::Vector3d corner(c & 1 ? half_m : -half_m, c & 2 ? half_m : -half_m,
                                         c & 4 ? half_m : -half_m);
            const double d = room.SignedDistance(p + T_world_grid.linear() * corner);
            low = std::min(low, d);
            high = std::max(high, d);
        }
        const bool is = occupancy.cells[i] == CellState::kOccupied;
        // Voxels round the room's edges off, and the smallest corners of cells hold no sample.
        if (low < -kVoxel_m && high > kVoxel_m) {
            ASSERT_TRUE(is) << p.transpose();
        }
        ASSERT_FALSE(is && std::abs(room.SignedDistance(p)) > half_m * std::sqrt(3.0) + 0.01);
        occupied += is;
    });
    EXPECT_GT(occupied, 5000);
}

TEST_F(Occupancies, FreeIsWhatACameraSawInFrontOfTheSurface) {
    const Occupancy occupancy = Make();
    int free = 0, hidden = 0;
    ForEachCell([&](std::size_t i, const Eigen::Vector3d& p) {
        const double distance_m = room.SignedDistance(p);
        const bool is_free = occupancy.cells[i] == CellState::kFree;
        if (distance_m < -0.01) {
            ASSERT_FALSE(is_free) << p.transpose();
        }
        if (distance_m < 0.3) return;  // far from surfaces, only cameras tell
        bool surely = false, perhaps = false;
        for (const StampedPose& pose : path) {
            const bool clear = !NearSilhouette(pose.T_world_camera, p);
            surely |= clear && InFront(pose.T_world_camera, p, 2) > 0.05;
            perhaps |= !clear || InFront(pose.T_world_camera, p, -1) > 0;
        }
        if (surely) {
            ASSERT_TRUE(is_free) << p.transpose();
        }
        if (!perhaps) {
            ASSERT_EQ(occupancy.cells[i], CellState::kUnknown) << p.transpose();
        }
        free += surely;
        hidden += !perhaps;
    });
    EXPECT_GT(free, 3000);
    EXPECT_GT(hidden, 3000);
}

TEST_F(Occupancies, RangeAndNumberOfViewsBoundWhatIsCarved) {
    const auto count = [](const Occupancy& o) {
        return std::count(o.cells.begin(), o.cells.end(), CellState::kFree);
    };
    const Occupancy all = Make();
    // Nothing is so near, so only the band is free.
    const Occupancy near = Make({.max_range_m = 0.3});
    EXPECT_LT(count(near) + 8000, count(all));
    const std::vector<StampedPose> whole = path;
    const auto sees = [&](std::vector<StampedPose> poses, int views) {
        path = std::move(poses);
        return Make({.most_views = views}).cells;
    };
    EXPECT_TRUE(sees(whole, 1) == sees({whole[0]}, 1));
    EXPECT_TRUE(sees(whole, 3) == sees({whole[0], whole[2], whole[4]}, 3));
    EXPECT_TRUE(sees(whole, 4) == sees({whole[0], whole[2], whole[4]}, 3));
    EXPECT_TRUE(sees(whole, 100) == all.cells);
    EXPECT_FALSE(sees(whole, 1) == all.cells);
    EXPECT_TRUE(sees({}, 10) == near.cells);
}

TEST_F(Occupancies, HolesInTheMapAreNotCarvedThrough) {
    // Without the ball and the far wall, rays see nothing there.
    for (BlockId id = 1; id < map.size(); ++id)
        if (map.coord(id).z >= 5) map.Release(id);
    const Occupancy occupancy = Make();
    ForEachCell([&](std::size_t i, const Eigen::Vector3d& p) {
        if (p.z() < 0.9 || room.SignedDistance(p) < 0.3) return;
        ASSERT_EQ(occupancy.cells[i], CellState::kUnknown) << p.transpose();
    });
}

TEST_F(Occupancies, EveryNumberOfThreadsGivesTheSame) {
    const Occupancy any = Make();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(Make().cells == any.cells);
    CellGrid fine = grid;
    fine.resolution_m = 0.004;
    EXPECT_NE(MakeOccupancy(map, fine, SmallCamera(), path, {}).message().find("at least 0.005"),
              std::string::npos);
}

}  // namespace
}  // namespace tessera
