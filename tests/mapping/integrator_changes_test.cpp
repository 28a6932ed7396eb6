// Surfaces that are gone, and depth that cannot be true.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "mapping/integrator.h"
#include "mapping/integrator_fixture.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::SmallCamera;

// A person stood at 1 m for ten seconds and has left. Where gone_m says so, a third of a second is
// enough to clear the map.
TEST(Integrator, ASurfaceThatIsGoneIsForgottenSoon) {
    const PinholeCamera camera = SmallCamera();
    for (const bool known : {false, true}) {
        BlockMap map(MapConfig());
        Integrator integrator({}, camera);
        for (int i = 0; i < 300; ++i)
            integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {90, 120, 30})), {}, map);
        PreparedFrame wall = Prepare(UniformFrame(camera, 2.0f, {90, 120, 30}));
        if (known) wall.gone_m = DepthImage(camera.width, camera.height, 2.0f);
        for (int i = 0; i < 10; ++i) integrator.Integrate(wall, {}, map);
        int solid = 0, free = 0;
        ForKnownVoxels(map,
                       [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
                           if (p.z() > 1.07 || p.head<2>().norm() > 0.2 * p.z())
                               return;  // only the centre of the image
                           (FieldDistance(field) > 0 ? free : solid) += 1;
                       });
        EXPECT_GT(free, 1000);
        if (known)
            EXPECT_EQ(solid, 0);
        else
            EXPECT_GT(solid, 300);
    }
}

TEST(Integrator, HostileDepthStaysBounded) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator::Config config;
    config.max_new_blocks = 1000;
    Integrator integrator(config, camera);
    Frame frame = UniformFrame(camera, 0.0f, {1, 2, 3});
    EXPECT_EQ(integrator.Integrate(Prepare(frame), {}, map).new_blocks, 0);  // no depth

    frame = UniformFrame(camera, 65.535f, {1, 2, 3});
    EXPECT_EQ(integrator.Integrate(Prepare(frame), {}, map).new_blocks, 0);  // out of range

    std::uint32_t random = 1;
    for (float& z : std::span(frame.depth_m.data(), frame.depth_m.size())) {
        random = random * 1664525u + 1013904223u;
        z = static_cast<float>(random >> 8) * (6.0f / (1 << 24));
    }
    const Integrator::Report report = integrator.Integrate(Prepare(frame), {}, map);
    EXPECT_LE(report.new_blocks, 1000);
    for (float& z : std::span(frame.depth_m.data(), frame.depth_m.size()))
        z = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(integrator.Integrate(Prepare(frame), {}, map).new_blocks, 0);
}

TEST(Integrator, SeenThroughIsClearedAgain) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator integrator({}, camera);
    for (int i = 0; i < 3; ++i)
        integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {9, 9, 9})), {}, map);
    for (int i = 0; i < 60; ++i)
        integrator.Integrate(Prepare(UniformFrame(camera, 2.0f, {9, 9, 9})), {}, map);
    ForKnownVoxels(map, [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
        if (p.z() > 1.2 || std::abs(p.x()) > 0.3 || std::abs(p.y()) > 0.3) return;
        ASSERT_GT(FieldDistance(field), 0.0f) << p.transpose();
    });
}

}  // namespace
}  // namespace tessera
