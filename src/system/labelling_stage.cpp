#include "system/labelling_stage.h"

#include <exception>

#include "core/check.h"
#include "core/stopwatch.h"

namespace tessera {

namespace {

MovingHint HintOf(const Frame& frame, const PinholeCamera& camera,
                  std::span<const Detection> dynamic, LabelRegion region) {
    MovingHint hint;
    hint.stamp_s = frame.stamp_s;
    if (dynamic.empty()) return hint;
    LabelImage labels;
    MakeLabelImage(frame.depth_m, camera, dynamic, region, labels);
    hint.depth_m = frame.depth_m;
    for (std::size_t i = 0; i < hint.depth_m.size(); ++i) {
        const std::uint8_t pixel = labels.detection.data()[i];
        if (pixel == 0 || pixel == LabelImage::kBesideObjects) hint.depth_m.data()[i] = 0;
    }
    return hint;
}

}  // namespace

bool LabellingStage::Detect(const Frame& frame, LabelReport& report, std::string& message) {
    message.clear();
    if (broken_) return false;
    Stopwatch watch;
    const auto detect = [&]() -> Result<std::vector<Detection>> {
        try {
            return detector_->Detect(frame);
            // An exception from a detector must not end the run.
        } catch (const std::exception& error) {
            return Status::Error(error.what());
        }
    };
    Result<std::vector<Detection>> found = detect();
    if (!found.ok()) {
        broken_ = true;
        message = "labelling has stopped, the run continues: " + found.message();
        return false;
    }
    report = {};
    report.stamp_s = frame.stamp_s;
    report.colour_stamp_s = frame.colour_stamp_s;
    report.detections = std::move(found.value());
    const std::vector<Detection> dynamic =
        ExtractDynamic(classes_, config_.min_probability, report.detections);
    report.moving = HintOf(frame, camera_, dynamic, config_.region);
    FilterWanted(classes_, config_.min_probability, report.detections);
    report.detect_ms = watch.LapMs();
    return true;
}

LabellingThread::LabellingThread(LabellingStage stage, Wake& mapping)
    : stage_(std::move(stage)),
      answers_(kUntaken + 2, mapping),
      worker_(1, [this](Job& job) { Detect(job); },
              {.low_priority = true, .begin = [this] { stage_.WorkInBackground(); }}) {}

std::unique_ptr<Frame> LabellingThread::Offer(Job job) {
    if (broken_.load() || answers_.size() >= kUntaken) return std::move(job.frame);
    auto dropped = worker_.PushNewest(std::move(job));
    return dropped ? std::move(dropped->frame) : nullptr;
}

void LabellingThread::Detect(Job& job) {
    Answer answer;
    answer.job = std::move(job);
    if (!stage_.Detect(*answer.job.frame, answer.report, answer.message)) broken_.store(true);
    TESSERA_CHECK(answers_.TryPush(std::move(answer)), "more answers than jobs");
}

}  // namespace tessera
