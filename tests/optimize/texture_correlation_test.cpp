#include "optimize/texture_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>

#include "optimize/painted_corner.h"

namespace tessera {
namespace view_test {
namespace {

DenseView ViewOf(const Eigen::Isometry3d& T_world_camera,
                 const std::function<double(const Eigen::Vector3d&)>& paint) {
    return MakeDenseView(ReducedFrom(T_world_camera, Scene::kCorner, paint), kViewCamera);
}

// In another light, which falls off to one side, the same paint correlates; other paint on the same
// walls does not.
TEST(TextureCorrelation, TellsPaintFromLight) {
    const auto painted = [](const Eigen::Isometry3d& T_world_camera, unsigned seed,
                            double fall_off) {
        // Patches of 4 cm, each of one shade.
        return ViewOf(T_world_camera, [=](const Eigen::Vector3d& p) {
            const auto cell = [](double v) {
                return static_cast<unsigned>(static_cast<std::int64_t>(std::floor(25 * v)) + 500);
            };
            const unsigned shade = (cell(p.x()) * 73856093u ^ cell(p.y()) * 19349663u ^
                                    cell(p.z()) * 83492791u ^ seed) *
                                   2654435761u;
            return (0.3 + 0.4 * (shade >> 16 & 255) / 255.0) * (0.9 - fall_off * p.x());
        });
    };
    const Eigen::Isometry3d T_a_b = Moved(0.05, 0.1);
    const DenseView a = painted(Eigen::Isometry3d::Identity(), 1, 0);
    EXPECT_GT(TextureCorrelation(a, painted(T_a_b, 1, 0), T_a_b), 0.85);
    EXPECT_GT(TextureCorrelation(a, painted(T_a_b, 1, 0.25), T_a_b), 0.85);
    EXPECT_LT(std::abs(TextureCorrelation(a, painted(T_a_b, 2, 0), T_a_b)), 0.2);
    const Eigen::Isometry3d away = Moved(0, 0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY());
    EXPECT_EQ(TextureCorrelation(a, painted(away, 1, 0), away), 0);
}

}  // namespace
}  // namespace view_test
}  // namespace tessera
