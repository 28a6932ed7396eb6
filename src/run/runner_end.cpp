// How a run ends: the final path, the mesh and the files, then the window.
#include <fmt/format.h>

#include "io/trajectory.h"
#include "run/runner.h"
#include "system/run_control.h"

namespace tessera {

Status Runner::Finish(const Status& outcome) {
    RunSummary& s = summary_;
    s.exit = !outcome.ok() ? "failed: " + outcome.message() : (s.stopped ? "stopped" : "finished");
    s.map = engine_->map_statistics();
    Status written = Correct();
    if (Status mesh = output_ ? WriteMesh() : Status::Ok(); written.ok()) written = mesh;
    s.fps = s.wall_s > 0 ? static_cast<double>(s.counts.frames) / s.wall_s : 0;
    s.peak_rss_mb = MeasureProcess().peak_rss_mb;
    s.stages = times_.Summarise();
    if (request_.poses_file.empty())
        if (Result<AteResult> ate = Evaluate(); ate.ok()) s.ate = std::move(ate.value());
    if (Status status = output_ ? output_->Finish(s) : Status::Ok(); written.ok()) written = status;
    return written;
}

// A window opens when the source has: a run that was refused before has none to wait for.
void Runner::ServeWindow(const std::atomic<bool>& stop) {
    ViewerLink* const link = request_.viewer;
    if (!opened_ || link == nullptr || !link->open.load() || stop.load()) return;
    const bool has_map = engine_->has_map();
    link->keeps_map.store(has_map);
    link->ended.store(true);
    if (!has_map)
        Warn(fmt::format(
            "the window goes on showing the surface as it was during the run; to see and measure "
            "the final one: tessera view {}",
            request_.output_folder));
    bool sent = !has_map;
    while (link->open.load() && !stop.load()) {
        ViewerCommand command;
        if (link->commands.TryPop(command)) {
            if (has_map) engine_->Save(command);
            while (const auto notice = engine_->TakeNotice()) Warn(*notice);
            continue;
        }
        if (!sent) sent = engine_->SendFinalMesh();
        RunControl::SleepBriefly();
    }
    link->keeps_map.store(false);
}

// If this recording's clock began before the scan's last frame, its frames alone can be told apart
// by their stamps.
Result<AteResult> Runner::Evaluate() const {
    const auto paths = SplitByClock(estimate_), truths = SplitByClock(truth_);
    const bool whole = paths.size() == 1 && truths.size() == 1;
    return EvaluateAte(truths.back(), paths.back(),
                       {.frames = summary_.counts.frames + (whole ? frames_before_ : 0)});
}

// Takes over the final poses and the refined calibration.
Status Runner::Correct() {
    summary_.calibration = engine_->calibration();
    std::vector<StampedPose> path = engine_->CorrectedPath();
    if (path.empty()) return Status::Ok();
    CountLeftOut(path);
    estimate_ = std::move(path);
    return output_ ? output_->ReplacePath(estimate_) : Status::Ok();
}

Status Runner::WriteMesh() {
    Stopwatch watch;
    const bool sound = engine_->status().ok();
    if (request_.viewer != nullptr && request_.viewer->open.load()) engine_->KeepMap();
    TriangleMesh mesh = engine_->TakeMesh();
    if (sound && !engine_->status().ok()) return engine_->status();
    while (const auto notice = engine_->TakeNotice()) Warn(*notice);
    if (summary_.labels) summary_.labels->objects = engine_->objects();
    if (summary_.labels && request_.viewer != nullptr)
        request_.viewer->objects.Push(std::vector<MapObject>(engine_->objects()));
    times_.Add("mesh", watch.LapMs());
    return output_->WriteMesh(std::move(mesh));
}

}  // namespace tessera
