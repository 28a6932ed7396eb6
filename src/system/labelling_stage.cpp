#include "system/labelling_stage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <exception>

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

void LabellingStage::WorkInBackground() {
    constexpr int kNice = 10;
    // Linux: affects only this thread. If it is refused, the thread keeps normal priority.
    static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice));
    detector_->WorkInBackground();
}

LabellingThread::LabellingThread(LabellingStage stage, Wake& mapping)
    : stage_(std::move(stage)), answers_(2, mapping), thread_([this] { Work(); }) {}

LabellingThread::~LabellingThread() {
    stop_.store(true);
    wake_.Notify();
}

std::unique_ptr<Frame> LabellingThread::Offer(Job job) {
    if (broken_.load()) return std::move(job.frame);
    auto dropped = jobs_.Push(std::move(job));
    return dropped ? std::move(dropped->frame) : nullptr;
}

bool LabellingThread::TryTake(Answer& answer) {
    if (!answers_.TryPop(answer)) return false;
    wake_.Notify();
    return true;
}

void LabellingThread::Work() {
    stage_.WorkInBackground();
    while (!stop_.load()) {
        wake_.Wait([&] { return !jobs_.empty() || stop_.load(); });
        Answer answer;
        if (stop_.load() || !jobs_.TryPop(answer.job)) continue;
        if (!stage_.Detect(*answer.job.frame, answer.report, answer.message)) broken_.store(true);
        wake_.Wait([&] { return answers_.TryPush(std::move(answer)) || stop_.load(); });
    }
}

}  // namespace tessera
