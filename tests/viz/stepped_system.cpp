#include "viz/stepped_system.h"

#include <fmt/format.h>

#include "core/check.h"
#include "core/stopwatch.h"
#include "io/mesh_io.h"
#include "render/vertex_weight.h"

namespace tessera::testing_support {

SteppedSystem::SteppedSystem(ViewerLink& link, std::unique_ptr<FrameSource> source,
                             const PipelineConfig& config)
    : link_(link), config_(config), source_(std::move(source)) {
    StartAnew();
}

void SteppedSystem::StartAnew() {
    pipeline_ = std::make_unique<Pipeline>(config_, source_->info().camera);
    mesher_ = std::make_unique<Mesher>(MeshConfig{});
    clear_ = true;
    T_map_truth_.reset();
}

void SteppedSystem::Obey() {
    ViewerSettings settings;
    while (link_.settings.TryPop(settings)) {
        settings_.push_back(settings);
        if (settings.method_choices != wanted_.method_choices) pipeline_->Select(settings.method);
        wanted_ = settings;
        pipeline_->SetFusing(settings.fusing);
    }
    ViewerCommand command;
    while (link_.commands.TryPop(command)) {
        commands_.push_back(command);
        using Kind = ViewerCommand::Kind;
        if (command.kind == Kind::kPause || command.kind == Kind::kResume)
            paused_ = command.kind == Kind::kPause;
        if (command.kind == Kind::kStep) paused_ = one_step_ = true;
        if (command.kind == Kind::kRecord || command.kind == Kind::kStopRecording)
            link_.recording = command.kind == Kind::kRecord;
        link_.paused = paused_;
        if (command.kind == Kind::kReset) StartAnew();
        if (command.kind == Kind::kStop) stopped_ = true;
        if (command.kind == Kind::kSaveMesh) {
            const Status status = WritePly(command.path, mesher_->Assemble());
            link_.messages.Push(
                std::string(status.ok() ? "mesh saved: " + command.path : status.message()));
        }
    }
}

bool SteppedSystem::Step() {
    Obey();
    if (stopped_) return false;
    if (paused_ && !one_step_) return true;
    one_step_ = false;
    auto frame = std::make_shared<Frame>();
    Stopwatch watch;
    if (source_->Read(*frame).status != ReadStatus::kOk) return false;
    ProcessFrame(std::move(frame), watch.LapMs());
    return true;
}

void SteppedSystem::ProcessFrame(std::shared_ptr<const Frame> frame, double decode_ms) {
    FrameUpdate update;
    update.decode_ms = decode_ms;
    update.queues = {{"frames", 0}, {"meshes", link_.meshes.size()}};
    Stopwatch watch;
    update.report = pipeline_->Process(*frame);
    update.report.method_choices = wanted_.method_choices;
    update.latency_ms = decode_ms + watch.LapMs();
    const FrameReport& report = update.report;
    if (report.first && report.tracked() && frame->T_world_camera)
        T_map_truth_ = report.track.T_world_camera * frame->T_world_camera->inverse();
    if (T_map_truth_ && frame->T_world_camera)
        update.T_world_camera_truth = *T_map_truth_ * *frame->T_world_camera;
    mesher_->Update(pipeline_->map());
    SendMesh();
    update.mesh_ms = watch.LapMs();
    ++counts_.frames;
    counts_.tracked += report.tracked();
    counts_.fused += report.fused;
    counts_.lost += !report.tracked();
    counts_.poor += report.track.status == TrackStatus::kPoor;
    update.counts = counts_;
    const BlockMap& map = pipeline_->map();
    update.map = {map.size() - 1, map.bytes(), map.bytes_per_voxel()};
    SendImages(frame, report);
    if (report.first)
        link_.messages.Push(fmt::format("frame {}: the map begins here", report.index));
    link_.frames.Push(std::move(update));
}

void SteppedSystem::SendMesh() {
    MeshUpdate update;
    update.voxel_size_m = config_.map.voxel_size_m;
    update.clear = clear_;
    const BlockMap& map = pipeline_->map();
    const auto mark = [&](const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
        return VertexMark{owner.coord.x < 0 ? kLeftLabel : kNoLabel,
                          WeightStep(VertexWeight(map, owner, vertex))};
    };
    const auto blocks = builder_.Build(map, *mesher_, mark);
    update.blocks.assign(std::make_move_iterator(blocks.begin()),
                         std::make_move_iterator(blocks.end()));
    clear_ = false;
    const bool sent = link_.meshes.TryPush(std::move(update));
    TESSERA_CHECK(sent, "the test must let the viewer take the meshes");
}

void SteppedSystem::SendImages(const std::shared_ptr<const Frame>& frame,
                               const FrameReport& report) {
    ImageUpdate images;
    images.frame = frame;
    if (wanted_.show_prediction && report.tracked()) {
        PinholeCamera half = camera();
        half.width /= 2, half.height /= 2, half.fx /= 2, half.fy /= 2;
        half.cx = (half.cx + 0.5) / 2 - 0.5, half.cy = (half.cy + 0.5) / 2 - 0.5;
        auto view = std::make_shared<PredictedView>();
        caster_.Predict(pipeline_->map(), half, report.track.T_world_camera, 0.1f, 10.0f, *view);
        images.predicted = std::move(view);
    }
    link_.images.Push(std::move(images));
}

}  // namespace tessera::testing_support
