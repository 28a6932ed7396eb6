// Shared by the tests that compare the presets' trackers with the papers' energies: a preset's map,
// and the normal equations of a slow, literal second implementation.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/se3.h"
#include "mapping/integrator.h"
#include "synth/synthetic_source.h"
#include "system/run_config.h"

namespace tessera::testing_support {

inline constexpr int kFrames = 12, kStride = 4;

inline RunConfig PresetConfig(const std::string& preset) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    const Status status = LoadPresetOrFile(preset, parameters);
    EXPECT_TRUE(status.ok()) << status.message();
    return config;
}

// A preset's map of the first frames of the desk, fused from true poses, and the frame after them.
struct PresetMap {
    RunConfig config;
    PinholeCamera camera{160, 120, 131.25, 131.25, 79.5, 59.5};
    std::unique_ptr<BlockMap> map;
    Frame frame;
    PreparedFrame prepared;

    explicit PresetMap(const std::string& preset) : config(PresetConfig(preset)) {
        SynthConfig scene;
        scene.camera = camera;
        auto source = OpenSyntheticScene("synthetic:desk", scene);
        EXPECT_TRUE(source.ok());
        PipelineConfig& pipeline = config.pipeline;
        pipeline.map.voxel_size_m = 0.02;
        pipeline.fusion.volume.bounded = false;
        map = std::make_unique<BlockMap>(pipeline.map);
        Integrator integrator(pipeline.fusion, camera);
        std::optional<Eigen::Isometry3d> T_first_world;
        for (int i = 0; i <= kFrames; ++i) {
            source.value()->Seek(i * kStride);
            EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
            if (!T_first_world) T_first_world = frame.T_world_camera->inverse();
            frame.T_world_camera = *T_first_world * *frame.T_world_camera;
            PrepareFrame(frame, pipeline.frame, prepared);
            if (i == kFrames) break;
            Integrator::View view;
            view.T_world_camera = *frame.T_world_camera;
            integrator.Integrate(prepared, view, *map);
        }
    }

    // 1 cm and half a degree off the true pose.
    Eigen::Isometry3d Start() const {
        Vector6d twist;
        twist << 0.005, -0.006, 0.004, 0.006, -0.005, 0.007;
        return *frame.T_world_camera * Se3Exp(twist);
    }
    TrackInput Input() const {
        return {.frame = prepared,
                .map = *map,
                .T_world_camera_starts = {Start()},
                .T_world_camera_last = Start(),
                .motion = {}};
    }
};

// The normal equations of a sum of squares: J^T J and J^T r.
struct Normal {
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    double energy = 0;

    void Add(const Vector6d& jacobian, double residual, double weight) {
        H += weight * jacobian * jacobian.transpose();
        g += weight * residual * jacobian;
        energy += weight * residual * residual;
    }
};

// H relative to its largest element, g relative to what residuals of the mean size could give.
inline void ExpectEqual(const PoseTerm& ours, const Normal& slow) {
    EXPECT_LT((ours.H - slow.H).norm(), 1e-4 * slow.H.norm()) << ours.H << "\n\n" << slow.H;
    EXPECT_LT((ours.g - slow.g).norm(), 1e-4 * std::sqrt(slow.H.trace() * slow.energy));
    EXPECT_LT((ours.g - slow.g).norm(), 1e-3 * slow.g.norm());
}

}  // namespace tessera::testing_support
