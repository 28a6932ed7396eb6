// Shared by the tracker tests: a map fused from exact views of a box room, and each tracking method
// as the tests configure it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mapping/integrator.h"
#include "mapping/ray_caster.h"
#include "support/box_room.h"
#include "tracking/icp_tracker.h"
#include "tracking/sdf_tracker.h"

namespace tessera::testing_support {

inline PreparedFrame Prepare(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

// A map fused from exact views, and the camera used for them.
struct World {
    BoxRoom room;
    PinholeCamera camera = SmallCamera();
    BlockMap map{{.voxel_size_m = 0.02, .truncation_m = 0.08}};

    explicit World(const BoxRoom& r) : room(r) {
        Integrator integrator({}, camera);
        for (int i = 0; i < 12; ++i) {
            Integrator::View view;
            view.T_world_camera = SmoothPath(6 * i);
            integrator.Integrate(Prepare(room.Render(camera, view.T_world_camera)), view, map);
        }
    }

    TrackResult Track(Tracker& tracker, const PreparedFrame& frame,
                      const Eigen::Isometry3d& T_start, const Eigen::Isometry3d& T_last,
                      const FrameMotion& motion = {}) const {
        return tracker.Track({.frame = frame,
                              .map = map,
                              .T_world_camera_starts = {T_start},
                              .T_world_camera_last = T_last,
                              .since_last_s = 1.0 / 30,
                              .motion = motion});
    }

    TrackResult Track(Tracker& tracker, const Eigen::Isometry3d& T_true,
                      const Eigen::Isometry3d& T_start) const {
        return Track(tracker, Prepare(room.Render(camera, T_true)), T_start, T_start);
    }
};

// A tracker and the residual model it uses.
struct TestTracker {
    std::unique_ptr<ResidualModel> model;
    std::unique_ptr<Tracker> tracker;
    Tracker& operator*() const { return *tracker; }
};

inline ResidualModel::Config FixedAlpha(double alpha) {
    ResidualModel::Config config;
    config.alpha_mode = ResidualModel::AlphaMode::kFixed;
    config.alpha = alpha;
    return config;
}

// Uses every pixel and iterates until converged.
inline TestTracker FineSdf(const ResidualModel::Config& photometric, bool chroma = false) {
    SdfTracker::Config config;
    config.chroma = chroma;
    config.finest_step_px = 1;
    config.fine_iterations = 30;
    TestTracker t;
    t.model = std::make_unique<ResidualModel>(photometric);
    t.tracker = std::make_unique<SdfTracker>(config, SmallCamera(), TrackJudge({}), *t.model, true);
    return t;
}

inline TestTracker FineIcp(
    const ResidualModel::Config& photometric, bool colour = true,
    std::unique_ptr<ViewPredictor> predictor = std::make_unique<RayCaster>()) {
    IcpTracker::Config config;
    config.finest_step_px = 1;
    config.levels = 2;
    config.fine_iterations = 30;
    TestTracker t;
    t.model = std::make_unique<ResidualModel>(photometric);
    t.tracker = std::make_unique<IcpTracker>(config, SmallCamera(), TrackJudge({}), *t.model,
                                             colour, std::move(predictor));
    return t;
}

// `method` is the name used on the command line.
inline TestTracker FineTracker(const std::string& method) {
    if (method == "sdf") return FineSdf(FixedAlpha(0.1));
    if (method == "sdf-geometric") return FineSdf(FixedAlpha(0.0));
    return FineIcp(FixedAlpha(0.1), method == "icp-rgb");
}

}  // namespace tessera::testing_support
