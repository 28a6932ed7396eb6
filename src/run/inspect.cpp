#include "run/inspect.h"

#include <optional>

#include "io/frame_reader.h"
#include "render/view_picture.h"
#include "run/open_source.h"
#include "semantics/label_picture.h"
#include "system/labelling_stage.h"
#include "system/pipeline.h"

namespace tessera {
namespace {

// The labelling part of a frame's life, on one thread.
class InspectedLabels {
  public:
    InspectedLabels(Labelling labelling, const LabelConfig& config, const PinholeCamera& camera,
                    MappingStage& mapping)
        : config_(config),
          camera_(camera),
          classes_(labelling.classes),
          stage_(std::move(labelling.detector), std::move(labelling.classes), config, camera),
          mapping_(mapping) {
        mapping_.EnableLabels(config_, classes_);
    }

    // Before the frame is tracked, because people may have to be masked.
    Status Detect(const Frame& frame, bool inspected, TrackingStage& tracking) {
        detected_ = inspected || labelled_frames_ % config_.stride == 0;
        if (!detected_) return Status::Ok();
        std::string message;
        if (!stage_.Detect(frame, report_, message)) return Status::Error(message);
        if (!report_.moving.depth_m.empty()) tracking.HintMoving(report_.moving, std::nullopt);
        return Status::Ok();
    }
    void Vote(const Frame& frame, const FrameReport& fused) {
        if (!fused.fused) return;
        ++labelled_frames_;
        if (detected_)
            mapping_.Label(report_.detections, frame.depth_m, fused.track.T_world_camera);
    }
    ColourImage Picture(const Frame& frame, const ColourImage& predicted_colour,
                        const Eigen::Isometry3d& T_world_camera) {
        LabelImage objects;
        MakeLabelImage(frame.depth_m, camera_, report_.detections, config_.region, objects);
        const Image<VertexLabel> predicted = mapping_.PredictLabels(T_world_camera);
        return LabelPicture(
            {frame.colour, report_.detections, objects, predicted_colour, predicted}, classes_);
    }

  private:
    LabelConfig config_;
    PinholeCamera camera_;
    LabelClasses classes_;
    LabellingStage stage_;
    MappingStage& mapping_;
    LabelReport report_;
    bool detected_ = false;  // `report_` is of this frame
    std::int64_t labelled_frames_ = 0;
};

}  // namespace

Result<Inspection> InspectFrame(const std::string& name, const RunConfig& config,
                                const std::string& detector, std::int64_t index) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<std::unique_ptr<FrameSource>> source = OpenSource(name, config);
    if (!source.ok()) return source.status();
    FrameReader reader(std::move(source.value()), {}, config.read_ahead);
    const PinholeCamera camera = reader.info().camera;
    Pipeline pipeline(config.pipeline, camera);
    std::optional<InspectedLabels> labels;
    if (!detector.empty()) {
        Result<Labelling> opened = OpenLabelling(detector, name, config.synthetic, config.labels);
        if (!opened.ok()) return opened.status();
        labels.emplace(std::move(opened.value()), config.labels, camera, pipeline.mapping());
    }
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
        const bool inspected = frame.index == index;
        if (labels)
            if (Status status = labels->Detect(frame, inspected, pipeline.tracking()); !status.ok())
                return status;
        pipeline.SetFusing(!inspected);
        Inspection result;
        result.report = pipeline.Process(frame);
        if (labels) labels->Vote(frame, result.report);
        if (!inspected) continue;
        const TrackResult& track = result.report.track;
        if (!result.report.tracked())
            return Status::Error(
                fmt::format("{}: frame {} was lost: {}", name, index, track.reason));
        PredictedView view;
        const float nearest_m = static_cast<float>(config.pipeline.frame.min_depth_m);
        const float farthest_m = static_cast<float>(config.pipeline.frame.max_depth_m);
        const auto predictor =
            MakePredictor(config.pipeline.trackers.icp.prediction, result.report.warning);
        predictor->Predict(pipeline.map(), camera, track.T_world_camera, nearest_m, farthest_m,
                           view);
        result.picture =
            labels ? labels->Picture(frame, view.colour, track.T_world_camera)
                   : ViewPicture(frame, view, track.gain, track.offset, result.report.moving.get());
        return result;
    }
}

}  // namespace tessera
