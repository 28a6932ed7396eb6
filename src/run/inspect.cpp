#include "run/inspect.h"

#include <optional>

#include "io/frame_reader.h"
#include "render/view_picture.h"
#include "run/open_source.h"
#include "semantics/label_picture.h"
#include "system/frame_labelling.h"
#include "system/pipeline.h"

namespace tessera {
namespace {

// Tracks, fuses and labels as a lockstep run does, but closes no loops.
class Inspector {
  public:
    Inspector(const RunConfig& config, const PinholeCamera& camera)
        : config_(config),
          camera_(camera),
          pipeline_(config.pipeline, camera),
          labelling_(config.labels, camera) {}

    Status BeginLabels(const std::string& detector, const std::string& source) {
        Result<Labelling> opened =
            OpenLabelling(detector, source, config_.synthetic, config_.labels);
        if (!opened.ok()) return opened.status();
        classes_ = opened.value().classes;
        pipeline_.mapping().EnableLabels(config_.labels, *classes_);
        labelling_.Begin(std::move(opened.value()));
        return Status::Ok();
    }

    // The last frame is not fused.
    Result<FrameReport> Process(const Frame& frame, bool last) {
        if (classes_) labelling_.Detect(frame, last, pipeline_.tracking());
        if (const std::string failure = labelling_.TakeFailure(); !failure.empty())
            return Status::Error(failure);
        if (last && classes_ && !labelling_.detected())
            return Status::Error(fmt::format(
                "frame {} has no colour image, in which the detector could look", frame.index));
        pipeline_.SetFusing(!last);
        FrameReport report = pipeline_.Process(frame);
        if (classes_ && report.fused)
            if (const std::optional<LabelReport> detected = labelling_.TakeDetections())
                pipeline_.mapping().Label(detected->detections, frame.depth_m,
                                          report.track.T_world_camera);
        return report;
    }

    // Of the last frame. May add a warning to its report.
    ColourImage Picture(const Frame& frame, FrameReport& report) {
        const TrackResult& track = report.track;
        PredictedView view;
        MakePredictor(config_.pipeline.trackers.icp.prediction, report.warning)
            ->Predict(pipeline_.map(), camera_, track.T_world_camera,
                      static_cast<float>(config_.pipeline.frame.min_depth_m),
                      static_cast<float>(config_.pipeline.frame.max_depth_m), view);
        if (!classes_)
            return ViewPicture(frame, view, track.gain, track.offset, report.moving.get());
        const std::vector<Detection>& detections = labelling_.detected()->detections;
        LabelImage objects;
        MakeLabelImage(frame.depth_m, camera_, detections, config_.labels.region, objects);
        return LabelPicture({frame.colour, detections, objects, view.colour,
                             pipeline_.mapping().PredictLabels(track.T_world_camera)},
                            *classes_);
    }

  private:
    const RunConfig& config_;
    PinholeCamera camera_;
    Pipeline pipeline_;
    FrameLabelling labelling_;
    std::optional<LabelClasses> classes_;  // set if objects are labelled
};

}  // namespace

Result<Inspection> InspectFrame(const std::string& name, const RunConfig& config,
                                const std::string& detector, std::int64_t index) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<std::unique_ptr<FrameSource>> source = OpenSource(name, config);
    if (!source.ok()) return source.status();
    FrameReader reader(std::move(source.value()), {}, config.read_ahead);
    Inspector inspector(config, reader.info().camera);
    if (!detector.empty())
        if (Status status = inspector.BeginLabels(detector, name); !status.ok()) return status;
    Frame frame;
    for (;;) {
        const ReadResult read = reader.Next(frame);
        if (read.status == ReadStatus::kEnd)
            return Status::Error(
                fmt::format("{}: no frame {} (see frames.csv or tessera info)", name, index));
        if (read.status == ReadStatus::kError) return Status::Error(read.message);
        if (read.status == ReadStatus::kSkip || read.status == ReadStatus::kWait) continue;
        if (frame.index > index)
            return Status::Error(fmt::format("{}: frame {} cannot be read", name, index));
        Result<FrameReport> report = inspector.Process(frame, frame.index == index);
        if (!report.ok()) return report.status();
        if (frame.index < index) continue;
        if (!report.value().tracked())
            return Status::Error(
                fmt::format("{}: frame {} was lost: {}", name, index, report.value().track.reason));
        Inspection result;
        result.picture = inspector.Picture(frame, report.value());
        result.report = std::move(report.value());
        return result;
    }
}

}  // namespace tessera
