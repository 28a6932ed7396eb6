#include "system/run.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "core/stopwatch.h"
#include "io/trajectory.h"
#include "optimize/pose_graph.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"
#include "system/open_source.h"
#include "system/run_output.h"
#include "system/run_window.h"

namespace tessera {
namespace {

class Runner {
  public:
    Runner(const RunRequest& request, const RunConfig& config, const RunObserver& observer)
        : request_(request), config_(config), observer_(observer), window_(request.viewer) {}

    Result<RunSummary> Run(const std::atomic<bool>& stop) {
        if (Status status = Open(stop); !status.ok()) return status;
        Status status = TakeOutcomes();
        if (status.ok() && !summary_.stopped && summary_.counts.frames == summary_.counts.skipped)
            status = Status::Error(request_.source + ": no frame could be read" +
                                   (summary_.last_reason.empty() ? "" : "; the last: " + summary_.last_reason));
        Status finished = Finish(status);
        if (!status.ok()) return status;
        if (!finished.ok()) return finished;
        return std::move(summary_);
    }

  private:
    Status Open(const std::atomic<bool>& stop) {
        if (Status status = config_.Validate(); !status.ok()) return status;
        if (Status status = CheckLoops(); !status.ok()) return status;
        std::vector<StampedPose> given;
        if (!request_.poses_file.empty()) {
            Result<Trajectory> poses = ReadTrajectory(request_.poses_file);
            if (!poses.ok()) return poses.status();
            given = std::move(poses.value().poses);
            pose_notes_ = std::move(poses.value().notes);
        }
        Result<std::unique_ptr<FrameSource>> source = OpenSource(request_.source, config_);
        if (!source.ok()) return source.status();
        summary_.source = source.value()->info();
        Labelling labelling;
        if (!request_.labels.empty()) {
            Result<Labelling> opened = OpenLabelling(request_.labels, request_.source, config_.synthetic, config_.labels);
            if (!opened.ok()) return opened.status();
            labelling = std::move(opened.value());
            class_names_ = labelling.classes;
            summary_.labels.emplace();
        }
        EngineInput input{std::move(source.value()), request_.selection, config_,
                          FramePlan(request_.switches, std::move(given), request_.poses_file), std::move(labelling), request_.record_path,
                          request_.viewer, &stop};
        if (request_.live)
            engine_ = std::make_unique<LiveEngine>(std::move(input));
        else
            engine_ = std::make_unique<LockstepEngine>(std::move(input));
        return Status::Ok();
    }

    Status CheckLoops() const {
        if (!config_.loops.enabled) return Status::Ok();
        if (!PoseGraphAvailable())
            return Status::Error("--loop-closure on: this build has no pose graph; install libceres-dev and build again");
        if (!request_.poses_file.empty())
            return Status::Error("--loop-closure on: with --poses the poses are given; leave one of the two out");
        return Status::Ok();
    }

    // With the first frame and not before: a run that is refused says one line, and leaves the results of an earlier one.
    Status Begin() {
        begun_ = true;
        if (!request_.output_folder.empty())
            if (Status status = OpenOutput(); !status.ok()) return status;
        if (observer_.on_open) observer_.on_open(summary_.source);
        for (const std::string& note : pose_notes_) Warn(note);
        return Status::Ok();
    }

    Status TakeOutcomes() {
        const double cpu_before_s = MeasureProcess().cpu_s;
        Stopwatch whole;
        FrameOutcome outcome;
        Status status;
        while (status.ok() && engine_->Next(outcome)) {
            if (!begun_) status = Begin();
            if (status.ok()) status = Take(outcome);
            if (observer_.on_frame) observer_.on_frame(summary_.counts, Total());
        }
        if (status.ok()) status = engine_->status();
        if (status.ok() && !begun_) status = Begin();
        summary_.stopped = engine_->stopped();
        summary_.wall_s = whole.LapMs() / 1000;
        summary_.cpu_s = MeasureProcess().cpu_s - cpu_before_s;
        return status;
    }

    Status Take(const FrameOutcome& outcome) {
        using Kind = FrameOutcome::Kind;
        switch (outcome.kind) {
            case Kind::kFrame: return TakeFrame(outcome);
            case Kind::kSkipped: Skip(outcome.message); break;
            case Kind::kDropped: ++summary_.counts.frames, ++summary_.counts.dropped; break;
            case Kind::kMessage: Warn(outcome.message); break;
            case Kind::kLabelsEnd: Warn(outcome.message), window_.EndLabels(); break;
            case Kind::kReset: return BeginAnew();
        }
        return Status::Ok();
    }

    Status TakeFrame(const FrameOutcome& outcome) {
        const FrameReport& report = outcome.report;
        Count(outcome);
        if (outcome.T_world_camera_truth) truth_.push_back({report.stamp_s, *outcome.T_world_camera_truth});
        if (report.tracked()) estimate_.push_back({report.stamp_s, report.track.T_world_camera});
        const double frame_ms = frame_watch_.LapMs();
        AddTimes(outcome, frame_ms);
        window_.Show(outcome, summary_.counts, TruthOf(outcome));
        if (outcome.labels)
            if (Status status = TakeLabels(*outcome.labels); !status.ok()) return status;
        return output_ ? output_->AddFrame(report, outcome.decode_ms, frame_ms) : Status::Ok();
    }

    Status TakeLabels(const LabelReport& report) {
        times_.Add("detect", report.detect_ms);
        times_.Add("label", report.vote_ms);
        ++summary_.labels->frames;
        summary_.labels->detections += static_cast<std::int64_t>(report.detections.size());
        summary_.labels->flips += report.votes.flips;
        window_.Show(report, class_names_);
        return output_ ? output_->AddDetections(report, class_names_) : Status::Ok();
    }

    void AddTimes(const FrameOutcome& outcome, double frame_ms) {
        const FrameReport& report = outcome.report;
        for (const auto& [stage, ms] : {std::pair{"frame", frame_ms}, {"decode", outcome.decode_ms},
                                        {"prepare", report.prepare_ms}, {"track", report.track_ms},
                                        {"allocate", report.fusion.allocate_ms}, {"fuse", report.fusion.fuse_ms}})
            times_.Add(stage, ms);
        if (request_.live) times_.Add("latency", outcome.latency_ms);
        if (config_.loops.enabled && !request_.live) times_.Add("loops", outcome.loops_ms);
        if (request_.viewer != nullptr) times_.Add("mesh_update", outcome.mesh_ms);
    }

    // The source's truth in the map's world.
    std::optional<Eigen::Isometry3d> TruthOf(const FrameOutcome& outcome) const {
        if (!outcome.T_world_camera_truth || estimate_.empty() || truth_.empty()) return std::nullopt;
        return estimate_.front().T_world_camera * truth_.front().T_world_camera.inverse() * *outcome.T_world_camera_truth;
    }

    // After a reset: the files, too, tell of the new world only.
    Status BeginAnew() {
        summary_.counts = {};
        if (summary_.labels) summary_.labels.emplace();
        truth_.clear();
        estimate_.clear();
        times_ = {};
        last_status_ = TrackStatus::kGood;
        last_degenerate_ = false;
        Warn("reset: the map and the path begin anew");
        return output_ ? OpenOutput() : Status::Ok();
    }

    Status OpenOutput() {
        Result<std::unique_ptr<RunOutput>> output = RunOutput::Open(request_, config_, summary_.source);
        if (!output.ok()) return output.status();
        output_ = std::move(output.value());
        return Status::Ok();
    }

    void Skip(const std::string& message) {
        ++summary_.counts.frames;
        ++summary_.counts.skipped;
        summary_.last_reason = message;
        Warn("skipped: " + message);
    }

    void Count(const FrameOutcome& outcome) {
        const FrameReport& report = outcome.report;
        RunCounts& n = summary_.counts;
        ++n.frames;
        n.tracked += report.tracked();
        n.fused += report.fused;
        n.unfused += outcome.fusion_dropped;
        n.poor += report.track.status == TrackStatus::kPoor;
        n.lost += !report.tracked();
        n.degenerate += report.track.degenerate;
        if (!report.tracked()) summary_.last_reason = report.track.reason;
        if (!report.warning.empty()) Warn(fmt::format("frame {}: {}", report.index, report.warning));
        SayWhenItChanges(report);
    }

    // A thousand lost frames in a row are one message, not a thousand.
    void SayWhenItChanges(const FrameReport& report) {
        const TrackResult& t = report.track;
        if (t.status != last_status_ || t.degenerate != last_degenerate_) {
            const std::string reason = t.reason.empty() ? "" : ": " + t.reason;
            if (t.status != TrackStatus::kGood)
                Warn(fmt::format("frame {}: {}{}", report.index,
                                 t.status == TrackStatus::kLost ? "lost" : "tracked badly, not fused", reason));
            else if (t.degenerate)
                Warn(fmt::format("frame {}: degenerate, the scene leaves some motion open{}", report.index, reason));
            else
                Warn(fmt::format("frame {}: tracking well again", report.index));
        }
        last_status_ = t.status;
        last_degenerate_ = t.degenerate;
    }

    Status Finish(const Status& outcome) {
        RunSummary& s = summary_;
        s.exit = !outcome.ok() ? "failed: " + outcome.message() : (s.stopped ? "stopped" : "finished");
        s.map = engine_->map_statistics();
        Status written = Correct();
        if (Status mesh = output_ ? WriteMesh() : Status::Ok(); written.ok()) written = mesh;
        s.fps = s.wall_s > 0 ? static_cast<double>(s.counts.frames) / s.wall_s : 0;
        s.peak_rss_mb = MeasureProcess().peak_rss_mb;
        s.stages = times_.Summarise();
        if (request_.poses_file.empty())
            if (Result<AteResult> ate = EvaluateAte(truth_, estimate_, {.frames = s.counts.frames}); ate.ok())
                s.ate = std::move(ate.value());
        if (Status status = output_ ? output_->Finish(s) : Status::Ok(); written.ok()) written = status;
        return written;
    }

    // The poses as they are known at the end.
    Status Correct() {
        std::vector<StampedPose> path = engine_->CorrectedPath();
        if (path.empty()) return Status::Ok();
        estimate_ = std::move(path);
        return output_ ? output_->ReplacePath(estimate_) : Status::Ok();
    }

    Status WriteMesh() {
        Stopwatch watch;
        const TriangleMesh mesh = engine_->TakeMesh();
        if (summary_.labels) summary_.labels->objects = engine_->objects();
        if (summary_.labels) window_.ShowObjects(engine_->objects());
        times_.Add("mesh", watch.LapMs());
        return output_->WriteMesh(mesh);
    }

    std::int64_t Total() const {
        const FrameSelection& selection = request_.selection;
        const std::int64_t all = summary_.source.frame_count;
        if (all < 0) return selection.count;
        const std::int64_t total = std::max<std::int64_t>(0, (all - selection.start + selection.stride - 1) / selection.stride);
        return selection.count < 0 ? total : std::min(total, selection.count);
    }

    void Warn(const std::string& text) {
        if (observer_.on_warning) observer_.on_warning(text);
        window_.Say(text);
    }

    const RunRequest& request_;
    const RunConfig& config_;
    const RunObserver& observer_;
    RunWindow window_;
    std::vector<StampedPose> truth_, estimate_;
    std::vector<std::string> pose_notes_;
    LabelClasses class_names_;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<RunOutput> output_;
    StageTimes times_;
    Stopwatch frame_watch_;
    RunSummary summary_;
    TrackStatus last_status_ = TrackStatus::kGood;
    bool last_degenerate_ = false;
    bool begun_ = false;
};

}  // namespace

MapStatistics StatisticsOf(const BlockMap& map) {
    return {map.size() - 1, map.bytes(), map.bytes_per_voxel()};
}

Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config, const RunObserver& observer,
                              const std::atomic<bool>& stop) {
    Runner runner(request, config, observer);
    if (config.threads == 0) return runner.Run(stop);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(config.threads));
    return tbb::task_arena(config.threads).execute([&] { return runner.Run(stop); });
}

}  // namespace tessera
