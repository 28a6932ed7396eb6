// How a run begins. runner_end.cpp has its end.
#include "run/runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/pipe_source.h"
#include "io/trajectory.h"
#include "run/earlier_run.h"
#include "run/noise_band.h"
#include "run/run_report.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"
#include "system/scan_plan.h"

namespace tessera {
namespace {

// Starts the shutter estimation from the rolling shutter found in the recording's first seconds,
// instead of the configured one.
void BeginShutter(const CameraReport& report, PipelineConfig& config, SourceInfo& source) {
    const CameraEstimate& estimate = report.estimate;
    if (report.known && !estimate.plausible()) return;
    const double given_s = config.shutter.colour_readout_s;
    if (!config.trackers.photometric.shutter.enabled || !estimate.shutter_shown(given_s)) return;
    config.trackers.photometric.shutter.readout_s = estimate.readout_s - given_s;
    source.notes.push_back(
        fmt::format("rolling shutter: read-out time of a colour image {:.1f} +- {:.1f} ms",
                    1000 * estimate.readout_s, 1000 * estimate.readout_sigma_s));
}

// After BeginShutter.
void BeginDepthShutter(const ColourDelay& delay, PipelineConfig& config, SourceInfo& source) {
    const double colour_s =
        config.shutter.colour_readout_s + config.trackers.photometric.shutter.readout_s;
    if (config.shutter.depth_readout_s != 0 || colour_s == 0 || !delay.depth_rolls) return;
    config.shutter.depth_readout_s = colour_s;
    source.notes.push_back("rolling shutter: depth is read row by row, as colour is");
}

// Nothing is fused, so a camera that leaves the map drifts: it must be lost instead.
void StayInTheMap(RunConfig& config) {
    double& least = config.pipeline.trackers.judge.min_known_fraction;
    least = std::max(least, config.loops.min_known_fraction);
}

}  // namespace

Result<RunSummary> Runner::Run(const std::atomic<bool>& stop) {
    if (Status status = Open(stop); !status.ok()) return status;
    Status status = TakeOutcomes();
    if (status.ok() && !summary_.stopped && frames_before_ == 0 &&
        summary_.counts.frames == summary_.counts.skipped)
        status = Status::Error(
            request_.source + ": no frame could be read" +
            (summary_.last_reason.empty() ? "" : "; last error: " + summary_.last_reason));
    Status finished = Finish(status);
    ServeWindow(stop);
    if (!status.ok()) return status;
    if (!finished.ok()) return finished;
    return std::move(summary_);
}

Status Runner::Open(const std::atomic<bool>& stop) {
    if (Status status = CheckRun(request_, config_); !status.ok()) return status;
    if (const std::string& folder = request_.output_folder; !folder.empty())
        if (Status status = CheckOutputFolder(request_.source, folder); !status.ok()) return status;
    std::vector<StampedPose> given;
    if (!request_.poses_file.empty()) {
        Result<Trajectory> poses = ReadTrajectory(request_.poses_file);
        if (!poses.ok()) return poses.status();
        given = std::move(poses.value().poses);
        notes_ = std::move(poses.value().notes);
    }
    if (request_.source.starts_with(kPipePrefix) && observer_.on_warning)
        observer_.on_warning(
            fmt::format("waiting for a sender of frames, at most {:g} s", kLongestWait_s));
    Result<CheckedSource> checked = OpenCheckedSource(request_, config_, &stop);
    if (!checked.ok()) return checked.status();
    TakeCamera(checked.value());
    std::unique_ptr<FrameSource> source = std::move(checked.value().source);
    if (!request_.resume && !request_.localise_only)  // a scan keeps its band
        if (std::string note = FitBandToNoise(request_.selection, config_.pipeline, source, stop);
            !note.empty())
            notes_.push_back(std::move(note));
    Labelling labelling;
    if (!request_.labels.empty()) {
        Result<Labelling> opened =
            OpenLabelling(request_.labels, request_.source, config_.synthetic, config_.labels);
        if (!opened.ok()) return opened.status();
        labelling = std::move(opened.value());
        if (Status status = BeginLabels(labelling.classes, request_.labels); !status.ok())
            return status;
    }
    Result<ScanPlan> scan = OpenScan();
    if (!scan.ok()) return scan.status();
    RunConfig config = config_;
    if (request_.localise_only) StayInTheMap(config);
    BeginShutters(config.pipeline);
    EngineInput input{
        std::move(source),
        selection_,
        std::move(config),
        FramePlan(request_.switches, std::move(given), request_.poses_file),
        std::move(scan.value()),
        std::move(labelling),
        [source = request_.source, synthetic = config_.synthetic, labels = config_.labels](
            const std::string& name) { return OpenLabelling(name, source, synthetic, labels); },
        request_.record_path,
        request_.viewer,
        request_.device,
        &stop};
    if (request_.live)
        engine_ = std::make_unique<LiveEngine>(std::move(input));
    else
        engine_ = std::make_unique<LockstepEngine>(std::move(input));
    if (const std::string warning = MemoryWarning(config_); !warning.empty()) Warn(warning);
    frame_watch_ = Stopwatch();  // the check of the camera is no frame's time
    return Status::Ok();
}

void Runner::TakeCamera(const CheckedSource& checked) {
    summary_.source = checked.source->info();
    summary_.found = checked.found;
    notes_.insert(notes_.end(), checked.messages.begin(), checked.messages.end());
}

void Runner::BeginShutters(PipelineConfig& config) {
    const CameraFindings& found = summary_.found;
    if (found.camera) BeginShutter(*found.camera, config, summary_.source);
    if (found.colour_delay) BeginDepthShutter(*found.colour_delay, config, summary_.source);
    summary_.depth_readout_s = config.shutter.depth_readout_s;
    summary_.colour_readout_s =
        config.shutter.colour_readout_s + config.trackers.photometric.shutter.readout_s;
}

Result<ScanPlan> Runner::OpenScan() {
    if (request_.scan_file.empty()) return ScanPlan();
    if (request_.localise_only) return OpenToLocalise(request_.scan_file, summary_.source, config_);
    if (!request_.resume) return BeginScan(request_.scan_file, summary_.source, config_);
    Result<ScanPlan> plan =
        ResumeScan(request_.scan_file, summary_.source, config_, !request_.labels.empty());
    if (!plan.ok()) return plan;
    const ScanContent& scan = *plan.value().resumed;
    selection_ = RestOf(request_.selection, summary_.source, scan);
    estimate_ = scan.Path();
    truth_ = scan.Truth();
    frames_before_ = static_cast<std::int64_t>(scan.path.size());
    return plan;
}

Status Runner::Begin() {
    begun_ = true;
    const std::string& folder = request_.output_folder;
    if (!folder.empty()) {
        Result<std::string> kept =
            KeepEarlierRun(folder, request_.resume ? ScanWrittenBy(request_) : "");
        if (!kept.ok()) return kept.status();
        if (!kept.value().empty())
            notes_.push_back(
                fmt::format("{}: the last run's results are now in {}", folder, kept.value()));
        if (Status status = OpenOutput(); !status.ok()) return status;
    }
    TellOpened();
    return Status::Ok();
}

// A scan that was killed after its last frame has no results yet.
Status Runner::BeginWithoutFrames() {
    if (frames_before_ == 0 || engine_->stopped()) {
        TellOpened();
        return Status::Ok();
    }
    notes_.push_back(request_.scan_file +
                     ": has all of these frames already; its results are written");
    return Begin();
}

void Runner::TellOpened() {
    opened_ = true;
    if (observer_.on_open) observer_.on_open(summary_.source);
    for (const std::string& note : notes_) Warn(note);
}

Status Runner::OpenOutput() {
    Result<std::unique_ptr<RunOutput>> output =
        RunOutput::Open(request_, config_, summary_.source, class_names_);
    if (!output.ok()) return output.status();
    output_ = std::move(output.value());
    return output_->AddPath(estimate_);
}

std::int64_t Runner::Total() const {
    const FrameSelection& selection = selection_;
    const std::int64_t all = summary_.source.frame_count;
    if (all < 0) return selection.count;
    const std::int64_t total = std::max<std::int64_t>(
        0, (all - selection.start + selection.stride - 1) / selection.stride);
    return selection.count < 0 ? total : std::min(total, selection.count);
}

void Runner::Warn(const std::string& text) {
    if (observer_.on_warning) observer_.on_warning(text);
    if (request_.viewer != nullptr) request_.viewer->messages.Push(std::string(text));
}

}  // namespace tessera
