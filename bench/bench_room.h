// What the kernel benchmarks and the convergence basin share: full-size views of the tests' exact
// room, and a map fused from them with true poses.
#pragma once

#include <memory>

#include "mapping/integrator.h"
#include "support/box_room.h"

namespace tessera::bench {

inline PinholeCamera FullCamera() {
    return {640, 480, 525, 525, 319.5, 239.5};
}

inline testing_support::BoxRoom RoomWithBall() {
    testing_support::BoxRoom room;
    room.has_ball = true;
    return room;
}

inline PreparedFrame Prepared(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

// The true pose of view i: ten views are a second and a third of a hand-held camera.
inline Eigen::Isometry3d TruePose(int i) {
    return testing_support::SmoothPath(4 * i);
}

// A map of 1 cm voxels from the first `views` views.
inline std::unique_ptr<BlockMap> FusedMap(const testing_support::BoxRoom& room, double truncation_m,
                                          int views) {
    BlockMap::Config config;
    config.truncation_m = truncation_m;
    auto map = std::make_unique<BlockMap>(config);
    Integrator integrator({}, FullCamera());
    for (int i = 0; i < views; ++i) {
        Integrator::View view;
        view.T_world_camera = TruePose(i);
        integrator.Integrate(Prepared(room.Render(FullCamera(), view.T_world_camera)), view, *map);
    }
    return map;
}

}  // namespace tessera::bench
