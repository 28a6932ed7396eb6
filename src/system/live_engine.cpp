#include "system/live_engine.h"

#include "core/check.h"

namespace tessera {

LiveEngine::LiveEngine(EngineInput input)
    : links_(input.device != nullptr, notices_, outcome_wake_, input.viewer),
      reading_(input, links_),
      mapping_(input.config, reading_.source(), input.device, input.viewer, links_) {
    status_ = Start(input);
    if (status_.ok())
        reading_thread_ = std::jthread([this] { Run(); });
    else
        ended_.store(true);
}

Status LiveEngine::Start(EngineInput& input) {
    if (!input.record_path.empty())
        if (Status status = reading_.StartRecording(input.record_path); !status.ok()) return status;
    LiveTracking::Settings tracking{input.config, reading_.source().camera, input.device,
                                    input.viewer, std::nullopt};
    if (input.scan.resumed) tracking.resume = TrackingResume::Of(input.scan);
    if (Status status = mapping_.Start(std::move(input.labelling), std::move(input.open_detector),
                                       std::move(input.scan));
        !status.ok())
        return status;
    tracking_.emplace(std::move(tracking), std::move(input.plan), links_, mapping_);
    return Status::Ok();
}

// A stop travels downstream: reading ends, tracking empties its queue, then mapping.
LiveEngine::~LiveEngine() { links_.quit.store(true); }

void LiveEngine::Run() {
    reading_.Run(*tracking_);
    tracking_->Finish();  // and mapping after it
    status_ = reading_.status();
    ended_.store(true);
    outcome_wake_.Notify();
}

bool LiveEngine::Next(FrameOutcome& outcome) {
    bool got = false;
    std::optional<std::string> notice;
    outcome_wake_.Wait([&] {
        // Read before the queues: whatever was pushed before the end is found. A queue that is not
        // empty may have nothing to give yet.
        const bool ended = ended_.load();
        got = links_.outcomes.TryPop(outcome);
        if (!got) notice = notices_.Take();
        return got || notice || ended;
    });
    if (got) return true;
    if (!notice) return false;
    outcome = {};
    outcome.kind = FrameOutcome::Kind::kMessage;
    outcome.message = std::move(*notice);
    return true;
}

TriangleMesh LiveEngine::TakeMesh() {
    TESSERA_CHECK(ended_.load(), "TakeMesh was called before the end");
    return mapping_.life().TakeMesh(status_, keep_map_);
}

std::vector<StampedPose> LiveEngine::CorrectedPath() const {
    return mapping_.loops() != nullptr && !mapping_.life().only_localise()
               ? mapping_.loops()->Path()
               : std::vector<StampedPose>();
}

std::optional<CalibrationReport> LiveEngine::calibration() const {
    return mapping_.loops() != nullptr ? mapping_.loops()->calibration() : std::nullopt;
}

}  // namespace tessera
