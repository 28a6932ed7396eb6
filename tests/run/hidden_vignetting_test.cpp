// A wall above a floor of boards, which show a motion along them by faint knots only.
#include <gtest/gtest.h>

#include <cmath>

#include "optimize/painted_room.h"
#include "run/recorded_views.h"
#include "run/source_camera.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

constexpr int kWallViews = 40;
constexpr double kWall_m = 1.3, kFloor_m = 0.35;
const PinholeCamera kWallCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

double Brightness(const Eigen::Vector3d& p) {
    if (p.z() > kWall_m - 1e-9) return 0.85;
    return 0.62 + 0.05 * std::sin(60 * p.z()) +
           0.015 * std::sin(21 * p.x()) * std::sin(33 * p.z() + 5 * p.x());
}

Frame WallAndFloor(int number, double vignetting) {
    const double t = 0.1 * number;
    const Eigen::Isometry3d T =
        Eigen::Translation3d(0.3 * std::sin(2 * t), 0.02 * std::cos(1.7 * t), 0) *
        Eigen::AngleAxisd(0.15 * std::sin(2 * t), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(0.1 * std::sin(1.4 * t), Eigen::Vector3d::UnitX());
    Frame frame;
    frame.stamp_s = frame.colour_stamp_s = t;
    frame.colour.Resize(kWallCamera.width, kWallCamera.height);
    frame.depth_m.Resize(kWallCamera.width, kWallCamera.height);
    for (int v = 0; v < kWallCamera.height; ++v)
        for (int u = 0; u < kWallCamera.width; ++u) {
            const Eigen::Vector3d ray = T.linear() * kWallCamera.Unproject(u, v, 1);
            double z = (kWall_m - T.translation().z()) / ray.z();
            if (ray.y() > 0) z = std::min(z, (kFloor_m - T.translation().y()) / ray.y());
            frame.colour(u, v) =
                painted_room::GreyAt(u, v, Brightness(T.translation() + z * ray), vignetting);
            frame.depth_m(u, v) = static_cast<float>(z);
        }
    return frame;
}

VignettingReport Found(double vignetting) {
    const TempFolder folder;
    std::vector<Frame> frames;
    for (int i = 0; i < kWallViews; ++i) frames.push_back(WallAndFloor(i, vignetting));
    CameraCalibration camera;
    camera.pinhole = kWallCamera;
    camera.depth_scale = 1000;
    WriteViews(folder, frames, camera);
    RunRequest request;
    request.source = folder.path();
    const Result<CheckedSource> checked = OpenCheckedSource(request, RunConfig());
    EXPECT_TRUE(checked.ok()) << checked.message();
    return checked.ok() ? checked.value().found.vignetting.value_or(VignettingReport{})
                        : VignettingReport{};
}

TEST(OpenCheckedSource, EvensOutDarkCornersThatHideThemselves) {
    const VignettingReport found = Found(0.27);
    EXPECT_TRUE(found.used);
    EXPECT_NEAR(found.share, 0.27, 0.03);
}

TEST(OpenCheckedSource, FindsNoDarkCornersWhereThereAreNone) { EXPECT_FALSE(Found(0).used); }

}  // namespace
}  // namespace tessera
