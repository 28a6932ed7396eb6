// A walk through the furnished room: frames with their true poses in the world of the first camera,
// each rendered once.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "mapping/map_copier.h"
#include "optimize/loop_closer.h"
#include "synth/synthetic_source.h"

namespace tessera::testing_support {

inline PinholeCamera RoomCamera() { return {320, 240, 262.5, 262.5, 159.5, 119.5}; }

// `count` of the walk's 720 frames: every `step`-th one from `first` on. The true poses are in the
// world of the walk's first camera.
inline std::vector<Frame> RoomWalk(int first, int count, int step) {
    SynthConfig config;
    config.camera = RoomCamera();
    config.sensor.noise = NoiseModel::kKinect;
    static const auto source = OpenSynthetic("room", config);
    EXPECT_TRUE(source.ok());
    static std::map<int, Frame> rendered;
    const auto read = [&](int index) {
        if (!rendered.contains(index)) {
            source.value()->Seek(index);
            source.value()->Read(rendered[index]);
        }
        return rendered[index];
    };
    const Eigen::Isometry3d T_camera_world = read(0).T_world_camera->inverse();
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i) {
        Frame frame = read(first + i * step);
        frame.T_world_camera = Normalised(T_camera_world * *frame.T_world_camera);
        frames.push_back(std::move(frame));
    }
    return frames;
}

inline FieldSettings RoomSettings() {
    FieldSettings settings;
    settings.camera = RoomCamera();
    settings.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    settings.tracker.finest_step_px = 1;
    return settings;
}

// Adds frames at given poses to a LoopCloser and to a map, as the system does, and applies the
// corrections.
struct Walker {
    explicit Walker(const LoopConfig& config, const FieldSettings& field = RoomSettings())
        : settings(field),
          closer(config, settings, 5000),
          map(std::make_unique<BlockMap>(settings.map)),
          integrator(settings.fusion, settings.camera) {}

    // Moves the camera by `T_last_camera`, the odometry. If `stored` is given, it is stored in
    // place of the frame.
    void Go(const Frame& frame, const Eigen::Isometry3d& T_last_camera,
            const Frame* stored = nullptr) {
        T_map_camera = Normalised(T_map_camera * T_last_camera);
        PreparedFrame prepared;
        PrepareFrame(frame, settings.preparation, prepared);
        Integrator::View view;
        view.T_world_camera = T_map_camera;
        integrator.Integrate(prepared, view, *map);
        TrackResult track;
        track.T_world_camera = T_map_camera;
        track.status = TrackStatus::kGood;
        track.inlier_fraction = 1;
        const std::string news =
            closer.Add(stored != nullptr ? *stored : frame, prepared, track, view, true);
        if (!news.empty()) all_news += std::to_string(frame.index) + ": " + news + "\n";
        if (moves_map && closer.WantsMap())
            closer.Move(copier.Copy(*map, integrator.revision(), map->size()));
        Take(closer.Step(LoopConfig{}.rebuild_frames));
    }
    void Take(std::optional<LoopCloser::Correction> correction) {
        if (!correction) return;
        if (correction->moved) {
            BlockMover mover = MoveRigidly(*map, ChangedSince(*map, copier.copied(*map)),
                                           correction->T_new_old, {});
            while (!mover.Step(*correction->map)) continue;
        }
        map = std::move(correction->map);
        integrator.MarkAllChanged(*map);
        T_map_camera = Normalised(correction->T_new_old * T_map_camera);
        ++corrections;
    }

    FieldSettings settings;
    LoopCloser closer;
    std::unique_ptr<BlockMap> map;
    Integrator integrator;
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    bool moves_map = false;  // for a corrected map, as live does
    MapCopier copier;
    std::string all_news;
    int corrections = 0;
};

}  // namespace tessera::testing_support
