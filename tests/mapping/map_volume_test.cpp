#include "mapping/map_volume.h"

#include <gtest/gtest.h>

#include "mapping/integrator.h"
#include "support/box_room.h"

namespace tessera {
namespace {

TEST(MapVolume, ABlockThatReachesInsideMeetsIt) {
    MapVolume volume;
    EXPECT_TRUE(volume.Meets({10000, 10000, 10000}, 0.16));
    volume.bounded = true;
    volume.min_x_m = -1, volume.max_x_m = 1;
    volume.min_y_m = -1, volume.max_y_m = 1;
    volume.min_z_m = 0.5, volume.max_z_m = 3;
    EXPECT_TRUE(volume.Meets({0, 0, 1}, 0.5));
    EXPECT_FALSE(volume.Meets({0, 0, 0}, 0.5));  // the block ends where the volume begins
    EXPECT_TRUE(volume.Meets({0, 0, 1}, 0.4));   // 0.4 to 0.8 m
    EXPECT_TRUE(volume.Meets({-3, 0, 3}, 0.4));  // -1.2 to -0.8 m
    EXPECT_FALSE(volume.Meets({-4, 0, 3}, 0.4));
    EXPECT_FALSE(volume.Meets({0, 3, 3}, 0.4));
}

TEST(MapVolume, RefusesAnEmptyBoxByItsKey) {
    MapVolume volume;
    volume.max_y_m = volume.min_y_m;
    EXPECT_TRUE(volume.Validate().ok());  // bounded is false, so the box is not checked
    volume.bounded = true;
    const Status status = volume.Validate();
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("mapping.volume.max_y_m"), std::string::npos)
        << status.message();
}

TEST(MapVolume, TheMapStaysInside) {
    const PinholeCamera camera = testing_support::SmallCamera();
    Frame frame;
    frame.depth_m = DepthImage(camera.width, camera.height, 2.0f);
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    Integrator::Config config;
    config.volume.bounded = true;
    config.volume.min_x_m = 0.1;
    config.volume.max_x_m = 0.4;
    BlockMap map({});
    Integrator integrator(config, camera);
    integrator.Integrate(prepared, {}, map);
    ASSERT_GT(map.size(), 20);
    const double block_m = map.config().voxel_size_m * kBlockSide;
    for (BlockId id = 1; id < map.size(); ++id) {
        EXPECT_GT((map.coord(id).x + 1) * block_m, 0.1);
        EXPECT_LT(map.coord(id).x * block_m, 0.4);
    }
}

}  // namespace
}  // namespace tessera
