#include "optimize/scan_calibration.h"

#include <utility>

#include "core/se3.h"
#include "optimize/calibration_view.h"
#include "optimize/self_calibration.h"

namespace tessera {
namespace {

// A view of each keyframe, prepared with the current settings.
Status LoadViews(const ScanGraph& graph, FrameStore& store, const FieldSettings& settings,
                 std::vector<CalibrationView>& views) {
    Frame frame;
    PreparedFrame prepared;
    for (const StoredFrame& stored : store.frames()) {
        if (!stored.is_keyframe) continue;
        Status loaded =
            store.LoadPrepared(stored, settings.camera, settings.preparation, frame, prepared);
        if (!loaded.ok())
            return Status::Error("calibration: keeping the given values, " + loaded.message());
        views.emplace_back(prepared.depth_m);
    }
    if (std::ssize(views) != graph.keyframes().size())
        return Status::Error(
            "calibration: keeping the given values, some keyframes' frames were dropped; raise "
            "loops.memory_limit_mb");
    return Status::Ok();
}

}  // namespace

Result<CalibrationReport> CalibrateScan(ScanGraph& graph, FrameStore& store,
                                        FieldSettings& settings) {
    constexpr double kNothing = 1e3;  // standard deviation of unknown values
    std::vector<CalibrationView> views;
    if (Status loaded = LoadViews(graph, store, settings, views); !loaded.ok()) return loaded;
    std::vector<PoseEdge> edges = graph.edges();
    std::vector<Eigen::Isometry3d> poses = graph.Poses();
    for (int i = 2; i < graph.keyframes().size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        edges.push_back({i - 2, i, Normalised(poses[at - 2].inverse() * poses[at]),
                         RootInformation(kNothing, kNothing), false});
    }
    auto report = RefineCalibration(settings.camera, views, edges, poses);
    if (!report.ok() || !report.value().shown) return report;
    graph.SetPoses(poses);
    graph.MarkCorrected();
    const auto& found = report.value().calibration;
    settings.camera = Corrected(settings.camera, found);
    settings.preparation.disparity_offset_per_m += found.disparity_offset_per_m;
    return report;
}

}  // namespace tessera
