// The first frames of the built-in desk, small, with their true poses: made once for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "mapping/prepared_frame.h"
#include "synth/synthetic_source.h"

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

}  // namespace tessera::testing_support
