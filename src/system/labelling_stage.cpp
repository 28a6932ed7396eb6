#include "system/labelling_stage.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string LabellingStopped(const std::string& why) {
    return "labelling has stopped, the run continues: " + why;
}

bool LabellingStage::Detect(const Frame& frame, LabelReport& report, std::string& message) {
    message.clear();
    if (broken_ || !detector_) return false;
    if (LacksColour(frame)) {
        broken_ = !had_colour_ && ++without_colour_ >= kMostWithoutColour;
        if (broken_)
            message = fmt::format("labels: none of the first {} frames has a colour image",
                                  kMostWithoutColour);
        return false;
    }
    had_colour_ |= !frame.colour.empty();
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
        message = found.message();
        return false;
    }
    report = {};
    report.stamp_s = frame.stamp_s;
    report.colour_stamp_s = frame.colour_stamp_s - frame.correction.colour_s;
    report.detections = std::move(found.value());
    const std::vector<Detection> dynamic =
        ExtractDynamic(classes_, config_.min_probability, report.detections);
    report.moving = HintOf(frame, camera_, dynamic, config_.region);
    FilterWanted(classes_, config_.min_probability, config_.overlap, report.detections);
    report.detect_ms = watch.LapMs();
    return true;
}

Status LabellingStage::Check(const Detector& detector) const {
    const std::vector<std::string>& names = detector.class_names();
    const auto is_known = [this](const std::string& name) {
        return classes_.IdOf(name) != 0 || classes_.IsDynamic(name);
    };
    if (classes_.count() == 0 || names.empty() || std::ranges::any_of(names, is_known))
        return Status::Ok();
    return Status::Error("it knows none of the classes of this run");
}

DetectorChange LabellingStage::Change(const std::string& name, const OpenDetectorFunction& open) {
    const auto refused = [&](const std::string& why) {
        return DetectorChange{fmt::format("the detector was not changed: {}", why), nullptr};
    };
    if (!open) return refused("this run cannot open another");
    const auto opened = [&]() -> Result<Labelling> {
        try {
            return open(name);
        } catch (const std::exception& error) {
            return Status::Error(name + ": " + error.what());
        }
    };
    Result<Labelling> labelling = opened();
    if (!labelling.ok()) return refused(labelling.message());
    if (Status status = Check(*labelling.value().detector); !status.ok())
        return refused(name + ": " + status.message());
    detector_ = std::move(labelling.value().detector);
    if (classes_.count() == 0)
        classes_ = std::move(labelling.value().classes);
    else
        classes_.SetKnown(detector_->class_names());
    broken_ = false;
    without_colour_ = 0;
    if (in_background_) detector_->WorkInBackground();
    return {"objects are detected with " + name, std::make_shared<const LabelClasses>(classes_),
            name};
}

LabellingThread::LabellingThread(LabellingStage stage, OpenDetectorFunction open, Wake& mapping)
    : stage_(std::move(stage)),
      open_(std::move(open)),
      changes_(4, mapping),
      answers_(kUntaken + 2, mapping),
      worker_(1, [this](Job& job) { Detect(job); },
              {.low_priority = true,
               .wake = &wake_,
               .has_idle_work = [this] { return !wanted_.empty(); },
               .idle = [this] { ChangeIfWanted(); },
               .begin = [this] { stage_.WorkInBackground(); }}) {}

std::unique_ptr<Frame> LabellingThread::Offer(Job job) {
    if (broken_.load() || answers_.size() >= kUntaken) return std::move(job.frame);
    auto dropped = worker_.PushNewest(std::move(job));
    return dropped ? std::move(dropped->frame) : nullptr;
}

void LabellingThread::ChangeIfWanted() {
    std::string name;
    if (!wanted_.TryPop(name)) return;
    DetectorChange change = stage_.Change(name, open_);
    if (change.classes) broken_.store(false);
    changes_.Push(std::move(change));
}

void LabellingThread::Detect(Job& job) {
    ChangeIfWanted();
    Answer answer;
    answer.job = std::move(job);
    if (!stage_.Detect(*answer.job.frame, answer.report, answer.message)) {
        broken_.store(stage_.broken());
        answer.looked_at = false;
        if (!answer.message.empty()) answer.message = LabellingStopped(answer.message);
    }
    TESSERA_CHECK(answers_.TryPush(std::move(answer)), "more answers than jobs");
}

}  // namespace tessera
