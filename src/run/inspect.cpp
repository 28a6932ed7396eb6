#include "run/inspect.h"

#include "io/frame_reader.h"
#include "render/view_picture.h"
#include "run/open_source.h"
#include "system/pipeline.h"

namespace tessera {

Result<Inspection> InspectFrame(const std::string& name, const RunConfig& config,
                                std::int64_t index) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<std::unique_ptr<FrameSource>> source = OpenSource(name, config);
    if (!source.ok()) return source.status();
    FrameReader reader(std::move(source.value()), {}, config.read_ahead);
    const PinholeCamera camera = reader.info().camera;
    Pipeline pipeline(config.pipeline, camera);
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
        pipeline.SetFusing(frame.index < index);
        Inspection result;
        result.report = pipeline.Process(frame);
        if (frame.index < index) continue;
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
            ViewPicture(frame, view, track.gain, track.offset, result.report.moving.get());
        return result;
    }
}

}  // namespace tessera
