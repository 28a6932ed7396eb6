#include "system/run.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "core/stopwatch.h"
#include "io/frame_reader.h"
#include "io/trajectory.h"
#include "system/open_source.h"
#include "system/run_output.h"

namespace tessera {
namespace {

MapStatistics StatisticsOf(const BlockMap& map) {
    return {map.size() - 1, map.bytes(), map.bytes_per_voxel()};
}

class Runner {
  public:
    Runner(const RunRequest& request, const RunConfig& config, const RunObserver& observer)
        : request_(request), config_(config), observer_(observer), switches_(request.switches) {
        std::ranges::stable_sort(switches_, {}, &MethodSwitch::frame);
    }

    Result<RunSummary> Run(const std::atomic<bool>& stop) {
        if (Status status = Open(); !status.ok()) return status;
        Status status = ReadFrames(stop);
        if (status.ok() && !summary_.stopped && summary_.counts.frames == summary_.counts.skipped)
            status = Status::Error(request_.source + ": no frame could be read" +
                                   (summary_.last_reason.empty() ? "" : "; the last: " + summary_.last_reason));
        Status finished = Finish(status);
        if (!status.ok()) return status;
        if (!finished.ok()) return finished;
        return std::move(summary_);
    }

  private:
    Status Open() {
        if (Status status = config_.Validate(); !status.ok()) return status;
        if (!request_.poses_file.empty()) {
            Result<Trajectory> poses = ReadTrajectory(request_.poses_file);
            if (!poses.ok()) return poses.status();
            given_ = std::move(poses.value().poses);
            pose_notes_ = std::move(poses.value().notes);
        }
        Result<std::unique_ptr<FrameSource>> source = OpenSource(request_.source, config_);
        if (!source.ok()) return source.status();
        reader_ = std::make_unique<FrameReader>(std::move(source.value()), request_.selection, config_.read_ahead);
        summary_.source = reader_->info();
        pipeline_ = std::make_unique<Pipeline>(config_.pipeline, summary_.source.camera);
        return Status::Ok();
    }

    // With the first frame and not before: a run that is refused says one line, and leaves the results of an earlier one.
    Status Begin() {
        begun_ = true;
        if (!request_.output_folder.empty()) {
            Result<std::unique_ptr<RunOutput>> output = RunOutput::Open(request_, config_, summary_.source);
            if (!output.ok()) return output.status();
            output_ = std::move(output.value());
        }
        if (observer_.on_open) observer_.on_open(summary_.source);
        for (const std::string& note : pose_notes_) Warn(note);
        return Status::Ok();
    }

    Status ReadFrames(const std::atomic<bool>& stop) {
        const double cpu_before_s = MeasureProcess().cpu_s;
        Stopwatch whole, frame_watch;
        Frame frame;
        Status status;
        while (status.ok()) {
            summary_.stopped = stop.load();
            if (summary_.stopped) break;
            const ReadResult read = reader_->Next(frame);
            if (read.status == ReadStatus::kEnd) break;
            if (read.status == ReadStatus::kError) status = Status::Error(read.message);
            if (read.status == ReadStatus::kWait) {
                if (!read.message.empty()) Warn(read.message);
                continue;
            }
            if (status.ok() && !begun_) status = Begin();
            if (!status.ok()) break;
            if (read.status == ReadStatus::kSkip)
                Skip(read.message);
            else
                status = ProcessFrame(frame, frame_watch);
            if (observer_.on_frame) observer_.on_frame(summary_.counts, Total());
        }
        reader_->RequestStop();
        summary_.wall_s = whole.LapMs() / 1000;
        summary_.cpu_s = MeasureProcess().cpu_s - cpu_before_s;
        return status;
    }

    Status ProcessFrame(const Frame& frame, Stopwatch& frame_watch) {
        const FrameReport report = Process(frame);
        Count(report);
        if (frame.T_world_camera) truth_.push_back({frame.stamp_s, *frame.T_world_camera});
        if (report.tracked()) estimate_.push_back({report.stamp_s, report.track.T_world_camera});
        const double frame_ms = frame_watch.LapMs();
        const double decode_ms = reader_->decode_ms();
        for (const auto& [stage, ms] : {std::pair{"frame", frame_ms}, {"decode", decode_ms},
                                        {"prepare", report.prepare_ms}, {"track", report.track_ms},
                                        {"allocate", report.fusion.allocate_ms}, {"fuse", report.fusion.fuse_ms}})
            times_.Add(stage, ms);
        return output_ ? output_->AddFrame(report, decode_ms, frame_ms) : Status::Ok();
    }

    FrameReport Process(const Frame& frame) {
        for (; next_switch_ < switches_.size() && switches_[next_switch_].frame <= frame.index; ++next_switch_)
            pipeline_->Select(switches_[next_switch_].method);
        if (given_.empty()) return pipeline_->Process(frame);
        if (const auto T_world_camera = InterpolatePose(given_, frame.stamp_s))
            return pipeline_->Process(frame, T_world_camera);
        FrameReport report;
        report.index = frame.index;
        report.stamp_s = frame.stamp_s;
        report.track.reason = request_.poses_file + " has no pose near this time";
        return report;
    }

    void Skip(const std::string& message) {
        ++summary_.counts.frames;
        ++summary_.counts.skipped;
        summary_.last_reason = message;
        Warn("skipped: " + message);
    }

    void Count(const FrameReport& report) {
        RunCounts& n = summary_.counts;
        ++n.frames;
        n.tracked += report.tracked();
        n.fused += report.fused;
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
        s.map = StatisticsOf(pipeline_->map());
        Status written = output_ ? WriteMesh() : Status::Ok();
        s.fps = s.wall_s > 0 ? static_cast<double>(s.counts.frames) / s.wall_s : 0;
        s.peak_rss_mb = MeasureProcess().peak_rss_mb;
        s.stages = times_.Summarise();
        if (given_.empty())
            if (Result<AteResult> ate = EvaluateAte(truth_, estimate_, {.frames = s.counts.frames}); ate.ok())
                s.ate = std::move(ate.value());
        if (Status status = output_ ? output_->Finish(s) : Status::Ok(); written.ok()) written = status;
        return written;
    }

    // Ends the map and the source: they and the whole mesh need not fit into memory together.
    Status WriteMesh() {
        reader_.reset();
        Stopwatch watch;
        TriangleMesh mesh;
        {
            Mesher mesher(config_.meshing);
            mesher.Update(pipeline_->map());
            pipeline_.reset();
            mesh = mesher.Assemble();
        }
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
    }

    const RunRequest& request_;
    const RunConfig& config_;
    const RunObserver& observer_;
    std::vector<MethodSwitch> switches_;  // by frame
    std::size_t next_switch_ = 0;
    std::vector<StampedPose> given_, truth_, estimate_;
    std::vector<std::string> pose_notes_;
    std::unique_ptr<FrameReader> reader_;
    std::unique_ptr<Pipeline> pipeline_;
    std::unique_ptr<RunOutput> output_;
    StageTimes times_;
    RunSummary summary_;
    TrackStatus last_status_ = TrackStatus::kGood;
    bool last_degenerate_ = false;
    bool begun_ = false;
};

}  // namespace

Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config, const RunObserver& observer,
                              const std::atomic<bool>& stop) {
    Runner runner(request, config, observer);
    if (config.threads == 0) return runner.Run(stop);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(config.threads));
    return tbb::task_arena(config.threads).execute([&] { return runner.Run(stop); });
}

}  // namespace tessera
