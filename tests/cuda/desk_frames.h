// The first frames of the built-in desk at low resolution, with their true poses. Rendered once per
// test program.
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

// A device memory limit that exceeds what the desk needs.
inline constexpr std::size_t kPlenty = std::size_t{1} << 30;

inline PinholeCamera DeskCamera() { return {160, 120, 131.25, 131.25, 79.5, 59.5}; }

struct DeskFrame {
    Frame frame;
    PreparedFrame prepared;
    Eigen::Isometry3d T_world_camera;  // the world frame is the first camera's
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
            f.T_world_camera =
                made.front().frame.T_world_camera->inverse() * *f.frame.T_world_camera;
        }
        return made;
    }();
    return frames;
}

// Fuses the first `frames` frames at their true poses on the CPU.
inline void FusedDesk(std::size_t frames, BlockMap& map) {
    Integrator integrator({}, DeskCamera());
    for (std::size_t i = 0; i < frames; ++i) {
        Integrator::View view;
        view.T_world_camera = DeskFrames()[i].T_world_camera;
        integrator.Integrate(DeskFrames()[i].prepared, view, map);
    }
}

// Bit-exact comparison.
inline void ExpectSameTrack(const TrackResult& track, const TrackResult& expected,
                            std::size_t frame) {
    EXPECT_EQ(track.status, expected.status) << frame << ": " << track.reason;
    EXPECT_EQ(track.iterations, expected.iterations) << frame;
    EXPECT_EQ(track.T_world_camera.matrix(), expected.T_world_camera.matrix()) << frame;
    EXPECT_EQ(track.known_fraction, expected.known_fraction) << frame;
    EXPECT_EQ(track.inlier_fraction, expected.inlier_fraction) << frame;
    EXPECT_EQ(track.distance_rms_m, expected.distance_rms_m) << frame;
    EXPECT_EQ(track.intensity_rms, expected.intensity_rms) << frame;
    EXPECT_EQ(track.alpha, expected.alpha) << frame;
}

template <class Pixel>
bool SameBytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
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
