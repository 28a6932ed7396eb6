// Runs an engine on the box room and stores its outcomes.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/box_room_source.h"
#include "support/temp_folder.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"
#include "system/viewer_link.h"

namespace tessera {

class EngineTest : public testing::Test {
  protected:
    using Source = testing_support::BoxRoomSource;
    using Kind = FrameOutcome::Kind;
    using Command = ViewerCommand::Kind;

    EngineTest() {
        config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
        config.pipeline.trackers.sdf.finest_step_px = 1;
        config.live.playback_speed = 1000;
    }

    EngineInput Input(const Source::Options& options) {
        EngineInput input;
        input.source = std::make_unique<Source>(options);
        input.config = config;
        input.viewer = viewer;
        input.stop = &stop;
        return input;
    }
    void Make(bool live, const Source::Options& options) {
        if (live)
            engine = std::make_unique<LiveEngine>(Input(options));
        else
            engine = std::make_unique<LockstepEngine>(Input(options));
    }

    // Takes and stores the next outcome. Returns false at the end.
    bool Next() {
        FrameOutcome outcome;
        if (!engine->Next(outcome)) return false;
        outcomes.push_back(std::move(outcome));
        return true;
    }
    void TakeAll() {
        while (Next()) {
        }
    }
    std::int64_t Count(Kind kind) const {
        return std::ranges::count(outcomes, kind, &FrameOutcome::kind);
    }
    std::vector<const FrameReport*> Reports() const {
        std::vector<const FrameReport*> reports;
        for (const FrameOutcome& o : outcomes)
            if (o.kind == Kind::kFrame) reports.push_back(&o.report);
        return reports;
    }
    std::string Messages() const {
        std::string all;
        for (const FrameOutcome& o : outcomes) all += o.message + "\n";
        return all;
    }
    void Ask(Command kind, const std::string& path = {}) { viewer->commands.Push({kind, path}); }

    // Sends random commands, all kinds except stop, while a simulated window reads its queues only
    // occasionally.
    void AskAtRandomToTheEnd(const TempFolder& folder) {
        std::mt19937 random(7);
        int saved = 0, chosen = 0;
        while (Next()) {
            switch (random() % 12) {
                case 0: Ask(Command::kReset); break;
                case 1: Ask(Command::kSaveMesh, folder / fmt::format("{}.ply", saved++ % 3)); break;
                case 2: Ask(Command::kPause), Ask(Command::kStep), Ask(Command::kResume); break;
                case 3: Ask(Command::kRecord, folder / fmt::format("raw{}", saved++)); break;
                case 4: Ask(Command::kStopRecording); break;
                case 7: Ask(Command::kSaveScan, folder / "random.scan"); break;
                case 5:
                case 6: {
                    ViewerSettings settings;
                    settings.method = kTrackingMethods[random() % kTrackingMethods.size()].method;
                    settings.method_choices = ++chosen;
                    settings.prealign = random() % 2 == 0;
                    settings.fusing = random() % 4 != 0;
                    settings.labels.on = random() % 2 == 0;
                    viewer->settings.Push(std::move(settings));
                    break;
                }
                default: {
                    MeshUpdate meshes;
                    ImageUpdate images;
                    viewer->meshes.TryPop(meshes);
                    viewer->images.TryPop(images);
                }
            }
            if (outcomes.size() > 1000) outcomes.clear();
        }
    }

    // Distance from the true position, in the world of the first camera.
    static double Error_m(const FrameReport& report, double speed = 1) {
        const Eigen::Isometry3d truth =
            testing_support::SmoothPath(0, speed).inverse() *
            testing_support::SmoothPath(static_cast<int>(report.index), speed);
        return (truth.inverse() * report.track.T_world_camera).translation().norm();
    }

    RunConfig config;
    ViewerLink* viewer = nullptr;
    std::atomic<bool> stop{false};
    std::unique_ptr<Engine> engine;
    std::vector<FrameOutcome> outcomes;
};

}  // namespace tessera
