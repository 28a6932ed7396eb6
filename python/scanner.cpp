#include "scanner.h"

#include <cmath>

#include "core/stopwatch.h"
#include "errors.h"
#include "run/run.h"
#include "semantics/open_detector.h"

namespace tessera::python {
namespace {

SourceInfo InfoOf(const PinholeCamera& camera) {
    SourceInfo info;
    info.name = "arrays";
    info.kind = "arrays from Python";
    info.camera = camera;
    return info;
}

}  // namespace

Scanner::Scanner(const PinholeCamera& camera, const RunConfig& config, const std::string& labels)
    : camera_(camera), feed_(std::make_shared<FrameFeed>()) {
    RunRequest request;
    request.labels = labels;
    ThrowIfBadInput(CheckPlausible(camera));
    ThrowIfBadInput(CheckRun(request, config));
    EngineInput input;
    input.source = std::make_unique<FeedSource>(feed_, InfoOf(camera));
    input.config = config;
    input.stop = &stop_;
    if (!labels.empty())
        input.labelling =
            ValueOrBadInput(OpenLabelling(labels, "arrays", config.synthetic, config.labels));
    if (config.threads > 0) {
        thread_limit_.emplace(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(config.threads));
        arena_.emplace(config.threads);
    }
    engine_ = std::make_unique<LockstepEngine>(std::move(input));
}

Scanner::~Scanner() {
    feed_->Close();
}  // otherwise the engine would wait for its reader, which waits for a frame

void Scanner::Check(const Frame& frame) const {
    if (final_mesh_)
        throw std::runtime_error("Scanner.track: the scan is finished; create a new Scanner");
    ThrowIfBroken(engine_->status());
    if (!std::isfinite(frame.stamp_s) || !std::isfinite(frame.colour_stamp_s))
        throw std::invalid_argument("stamp_s: must be a finite time in seconds");
    if (frames_ > 0 && frame.stamp_s <= last_stamp_s_)
        throw std::invalid_argument(
            fmt::format("stamp_s: {:.6f} is not later than the previous frame, {:.6f}",
                        frame.stamp_s, last_stamp_s_));
}

bool Scanner::Next(FrameOutcome& outcome) {
    return arena_ ? arena_->execute([&] { return engine_->Next(outcome); })
                  : engine_->Next(outcome);
}

FrameResult Scanner::Track(Frame frame) {
    const std::lock_guard lock(mutex_);
    Check(frame);
    last_stamp_s_ = frame.stamp_s;
    frame.index = frames_++;
    Stopwatch watch;
    FrameResult result;
    feed_->Push(std::move(frame));
    for (FrameOutcome outcome; Next(outcome);) {
        if (!outcome.message.empty()) result.messages.push_back(outcome.message);
        if (outcome.kind != FrameOutcome::Kind::kFrame) continue;
        result.report = std::move(outcome.report);
        if (!result.report.warning.empty()) result.messages.push_back(result.report.warning);
        if (result.report.tracked())
            path_.push_back({result.report.stamp_s, result.report.track.T_world_camera});
        result.frame_ms = watch.LapMs();
        return result;
    }
    ThrowIfBroken(engine_->status());
    throw std::runtime_error("Scanner.track: the scan has ended");
}

std::vector<StampedPose> Scanner::Path() const {
    const std::lock_guard lock(mutex_);
    return path_;
}

std::shared_ptr<TriangleMesh> Scanner::Mesh() const {
    const std::lock_guard lock(mutex_);
    if (final_mesh_) return final_mesh_;
    const auto snapshot = [&] { return std::make_shared<TriangleMesh>(engine_->mapping().Mesh()); };
    return arena_ ? arena_->execute(snapshot) : snapshot();
}

std::vector<std::string> Scanner::Finish() {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> messages;
    if (final_mesh_) return messages;
    feed_->Close();
    for (FrameOutcome outcome; Next(outcome);)
        if (!outcome.message.empty()) messages.push_back(outcome.message);
    if (std::vector<StampedPose> corrected = engine_->CorrectedPath(); !corrected.empty())
        path_ = std::move(corrected);
    const auto take = [&] { return std::make_shared<TriangleMesh>(engine_->TakeMesh()); };
    final_mesh_ = arena_ ? arena_->execute(take) : take();
    ThrowIfBroken(engine_->status());
    return messages;
}

std::vector<MapObject> Scanner::Objects() const {
    const std::lock_guard lock(mutex_);
    if (!final_mesh_)
        throw std::runtime_error(
            "Scanner.objects: objects belong to the final mesh; call finish() first");
    return engine_->objects();
}

}  // namespace tessera::python
