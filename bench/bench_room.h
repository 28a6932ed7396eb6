// Shared by the kernel benchmarks and the convergence basin: full-size views of the box room from
// the tests, and a map fused from them with true poses.
#pragma once

#include <cmath>
#include <memory>

#include "mapping/integrator.h"
#include "support/box_room.h"
#include "synth/hash_random.h"

namespace tessera::bench {

inline PinholeCamera FullCamera() { return {640, 480, 525, 525, 319.5, 239.5}; }

inline testing_support::BoxRoom RoomWithBall() {
    testing_support::BoxRoom room;
    room.has_ball = true;
    return room;
}

// One wall with a texture that does not repeat. The plane waves of BoxRoom repeat every 25 cm on
// it, so a tracker could not distinguish two positions.
struct NoiseWall : testing_support::BoxRoom {
    NoiseWall() { only_back_wall = true; }

    static double LatticeValue(int octave, int x, int y) {
        return UniformFromBits(
            MixBits(StreamKey(static_cast<std::uint64_t>(octave), static_cast<std::uint32_t>(x),
                              static_cast<std::uint32_t>(y))));
    }
    // Smooth interpolation between random values at lattice points.
    static double Noise(int octave, double x, double y) {
        const double cx = std::floor(x), cy = std::floor(y);
        const auto ease = [](double t) { return t * t * (3 - 2 * t); };
        const double fx = ease(x - cx), fy = ease(y - cy);
        const int i = static_cast<int>(cx), j = static_cast<int>(cy);
        return std::lerp(
            std::lerp(LatticeValue(octave, i, j), LatticeValue(octave, i + 1, j), fx),
            std::lerp(LatticeValue(octave, i, j + 1), LatticeValue(octave, i + 1, j + 1), fx), fy);
    }
    Frame Render(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera) const {
        Frame frame = BoxRoom::Render(camera, T_world_camera);
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d p =
                    T_world_camera * camera.Unproject(u, v, frame.depth_m(u, v));
                const double i = 0.5 * Noise(0, p.x() / 0.25, p.y() / 0.25) +
                                 0.35 * Noise(1, p.x() / 0.1, p.y() / 0.1);
                const auto grey = static_cast<std::uint8_t>(20.5 + 255.0 * i);
                frame.colour(u, v) = {grey, grey, grey};
            }
        return frame;
    }
};

inline PreparedFrame Prepared(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

// The true pose of view i. Ten views cover 1.33 s of hand-held motion.
inline Eigen::Isometry3d TruePose(int i) { return testing_support::SmoothPath(4 * i); }

// A map with 1 cm voxels, fused from the first `views` views.
template <class Room>
std::unique_ptr<BlockMap> FusedMap(const Room& room, double truncation_m, int views) {
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
