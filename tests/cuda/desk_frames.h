// The first frames of the built-in desk, small, with their true poses: made once for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "mapping/integrator.h"
#include "mapping/predicted_view.h"
#include "mapping/prepared_frame.h"
#include "synth/synthetic_source.h"
#include "tracking/tracker.h"

namespace tessera::testing_support {

inline PinholeCamera DeskCamera() { return {160, 120, 131.25, 131.25, 79.5, 59.5}; }

struct DeskFrame {
    Frame frame;
    PreparedFrame prepared;
    Eigen::Isometry3d T_world_camera;  // the world is the first camera
};

inline const std::vector<DeskFrame>& DeskFrames() {
    static const std::vector<DeskFrame> frames = [] {
        SynthConfig config;
        config.camera = DeskCamera();
        config.sensor.noise = NoiseModel::kKinect;
        auto source = OpenSyntheticScene("synthetic:desk", config);
        std::vector<DeskFrame> made(20);
        for (DeskFrame& f : made) {
            EXPECT_EQ(source.value()->Read(f.frame).status, ReadStatus::kOk);
            PrepareFrame(f.frame, {}, f.prepared);
            f.T_world_camera = made.front().frame.T_world_camera->inverse() * *f.frame.T_world_camera;
        }
        return made;
    }();
    return frames;
}

// The first so many frames at their true poses, by the portable path.
inline void FusedDesk(std::size_t frames, BlockMap& map) {
    Integrator integrator({}, DeskCamera(), VectorPath::kBaseline);
    for (std::size_t i = 0; i < frames; ++i) {
        Integrator::View view;
        view.T_world_camera = DeskFrames()[i].T_world_camera;
        integrator.Integrate(DeskFrames()[i].prepared, view, map);
    }
}

// Of one frame and the same map, where only the order of summation differs.
inline void ExpectSameTrack(const TrackResult& track, const TrackResult& expected, std::size_t frame) {
    EXPECT_EQ(track.status, TrackStatus::kGood) << track.reason;
    EXPECT_EQ(track.iterations, expected.iterations);
    const Eigen::Isometry3d difference = expected.T_world_camera.inverse() * track.T_world_camera;
    EXPECT_LT(difference.translation().norm(), 2e-6) << frame;
    EXPECT_LT(Se3Log(difference).head<3>().norm(), 2e-6) << frame;
    EXPECT_NEAR(track.known_fraction, expected.known_fraction, 1e-3);
    EXPECT_NEAR(track.intensity_rms, expected.intensity_rms, 1e-5);
}

template <class Pixel>
bool SameBytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    return a.width() == b.width() && a.height() == b.height() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
}

inline void ExpectSameView(const PredictedView& view, const PredictedView& expected) {
    EXPECT_EQ(view.camera, expected.camera);
    EXPECT_EQ(view.T_world_camera.matrix(), expected.T_world_camera.matrix());
    EXPECT_TRUE(SameBytes(view.depth_m, expected.depth_m));
    EXPECT_TRUE(SameBytes(view.normal_camera, expected.normal_camera));
    EXPECT_TRUE(SameBytes(view.colour, expected.colour));
    EXPECT_TRUE(SameBytes(view.intensity, expected.intensity));
}

}  // namespace tessera::testing_support
