#include "system/frame_mapping.h"

#include <fmt/format.h>

#include "core/check.h"
#include "core/process.h"
#include "core/stopwatch.h"
#include "io/mesh_io.h"
#include "system/run_control.h"

namespace tessera {

FrameMapping::FrameMapping(const RunConfig& config, const SourceInfo& source, Backend* device,
                           ViewerLink* viewer, bool wait, Notices& notices)
    : config_(config),
      source_(source),
      has_viewer_(viewer != nullptr),
      wait_(wait),
      notices_(notices),
      stage_(config.pipeline, config.meshing, source.camera, device),
      feed_(viewer, config.live.mesh_blocks) {
    label_settings_.prediction = config.labels.prediction;
}

Result<std::optional<LoopCloser::Memory>> FrameMapping::StartScan(ScanPlan plan) {
    only_localise_ = plan.only_localise();
    std::optional<ScanContent> resumed = std::exchange(plan.resumed, std::nullopt);
    continued_ = resumed.has_value();
    if (plan.file)
        scan_.emplace(std::move(plan), config_.scan, wait_, config_.loops.enabled, notices_);
    std::optional<LoopCloser::Memory> learnt;
    if (resumed) {
        if (Status status = Resume(*resumed); !status.ok()) return RefuseScan(std::move(status));
        learnt = TakeLoopMemory(*resumed);
    }
    if (Status status = StartPaging(); !status.ok()) return RefuseScan(std::move(status));
    return learnt;
}

// Nothing is written to it, at the end of the run either.
Status FrameMapping::RefuseScan(Status why) {
    scan_.reset();
    return why;
}

Status FrameMapping::Resume(ScanContent& scan) {
    if (scan_) scan_->Resume(scan.progress, *scan.map);
    stage_.Resume(std::move(scan.map), scan.progress.fused_frames);
    if (only_localise_ || scan.labels.empty()) return Status::Ok();
    StateReader labels(scan.labels);
    return stage_.LoadLabels(labels)
               ? Status::Ok()
               : Status::Error(scan_->path() +
                               ": its labels have other classes; give the same --labels and "
                               "labels.classes as when the scan was created");
}

Status FrameMapping::StartPaging() {
    if (!scan_ || !config_.pipeline.has_memory_limit()) return Status::Ok();
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(scan_->path());
    if (!reader.ok()) return reader.status();
    paging_ =
        std::make_unique<PagingStage>(config_.pipeline, source_.camera, std::move(reader.value()),
                                      wait_, stage_, *scan_, notices_);
    return Status::Ok();
}

// ---- A frame.

void FrameMapping::Begin() {
    if (paging_) paging_->BeginFrame();
}

void FrameMapping::Fuse(TrackedFrame& tracked, FrameOutcome& outcome) {
    if (paging_ && paging_->AfterTracking(tracked)) outcome.fusion_dropped = true;
    stage_.Fuse(tracked);
}

void FrameMapping::Label(const DepthImage& depth_m, const Eigen::Isometry3d& T_world_camera,
                         LabelReport& report) {
    Stopwatch watch;
    std::erase_if(report.detections, [this](const Detection& d) {
        return label_settings_.ignored[static_cast<std::size_t>(d.class_id)];
    });
    report.ignored = label_settings_.ignored;
    stage_.Apply(label_settings_);
    report.votes = stage_.Label(report.detections, depth_m, T_world_camera);
    report.vote_ms = watch.LapMs();
    if (std::string warning = stage_.labels_warning(); warning != labels_warning_)
        notices_.Tell(labels_warning_ = std::move(warning));
    if (scan_) scan_->Touch(report.votes.blocks);
}

void FrameMapping::Record(const Frame& frame, const TrackedFrame& tracked,
                          std::int64_t labelled_frames, FrameOutcome& outcome) {
    Stopwatch watch;
    if (scan_) scan_->AddFrame(frame, tracked, labelled_frames);
    if (has_viewer_ && !continued_) past_.push_back(RecordOf(frame, tracked));
    outcome.scan_ms = watch.LapMs();
}

void FrameMapping::AddLoops(LoopChanges changes) {
    if (scan_) scan_->AddLoops(std::move(changes));
}

void FrameMapping::Save(FrameOutcome& outcome) {
    Stopwatch watch;
    if (scan_) scan_->SaveIfDue(stage_);
    outcome.scan_ms += watch.LapMs();
    if (paging_) paging_->Release();
}

void FrameMapping::Report(const Frame& frame, const TrackedFrame& tracked, FrameOutcome& outcome) {
    outcome.report = tracked.report;
    outcome.T_world_camera_truth = frame.T_world_camera;
    outcome.mesh_ms = feed_.Send(frame, tracked.report, stage_);
    outcome.map = StatisticsOf(stage_.blocks());
}

// ---- Loop closure.

void FrameMapping::PutMap(LoopCloser::Correction correction, std::uint32_t moved_at) {
    if (correction.moved)
        stage_.ReplaceMoved(std::move(correction.map), correction.T_new_old, moved_at);
    else
        stage_.Replace(std::move(correction.map), std::move(correction.labels));
    if (paging_) {
        const auto* pager = dynamic_cast<const RebuildPaging*>(correction.pager.get());
        TESSERA_CHECK(pager != nullptr, "a corrected map without the pager of its blocks");
        paging_->Replaced(correction.T_new_old, *pager);
    }
    if (scan_) scan_->Move(correction.T_new_old);
}

MakeMapPager FrameMapping::MakePagers() const {
    return paging_ ? RebuildPagers(config_.pipeline, source_.camera, scan_->path())
                   : MakeMapPager();
}

void FrameMapping::LoadAround(const Eigen::Isometry3d& T_world_camera) {
    if (paging_) paging_->LoadAround(T_world_camera);
}

// ---- Commands of the user.

void FrameMapping::Reset() {
    stage_.Reset();
    if (scan_) scan_->Reset();
    continued_ = false;
    past_.clear();
    if (paging_) paging_->Reset();
    SendMesh();
}

void FrameMapping::SaveMesh(const std::string& path) {
    if (!mesh_writer_) mesh_writer_.emplace(1, [this](SavedMesh& saved) { WriteMesh(saved); });
    if (!mesh_writer_->idle()) return notices_.Tell("a mesh is still being saved; try again later");
    SavedMesh saved{path, paging_ ? paging_->MissingText() : "", stage_.Mesh()};
    if (saved.mesh.triangles.empty()) return notices_.Tell("no surface to save yet");
    TESSERA_CHECK(mesh_writer_->TryPush(std::move(saved)), "an idle thread has no room");
}

void FrameMapping::WriteMesh(const SavedMesh& saved) {
    const Status status = WritePly(saved.path, saved.mesh);
    notices_.Tell(status.ok() ? fmt::format("saved {}: {} triangles{}", saved.path,
                                            saved.mesh.triangles.size(), saved.note)
                              : status.message());
}

void FrameMapping::SaveScan(const std::string& path) { notices_.Tell(StartScanNow(path)); }

std::string FrameMapping::StartScanNow(const std::string& path) {
    if (only_localise_) return kMapIsKept;
    if (scan_) return ScanText("the scan is already being saved: ");
    if (config_.loops.refine_calibration)
        return "cannot save a scan with calibration.refine: its frames would have two different "
               "calibrations";
    Result<ScanPlan> plan = BeginScan(path, source_, config_);
    if (!plan.ok()) return plan.message();
    scan_.emplace(std::move(plan.value()), config_.scan, wait_, config_.loops.enabled, notices_);
    scan_->AddPast(past_);
    return "scan saved; it is kept up to date from now on: " + path;
}

std::string FrameMapping::ScanText(const char* if_saved) const {
    return (scan_->failed() ? "this scan could not be written and is no longer saved: "
                            : if_saved) +
           scan_->path();
}

// ---- The end.

void FrameMapping::Finish() {
    if (mesh_writer_) mesh_writer_->Finish();
    if (paging_) paging_->Close();
    while (scan_ && stage_.following()) stage_.Follow();  // a run that was quit
    if (scan_) scan_->Finish(stage_);
}

void FrameMapping::SaveAfterEnd(const ViewerCommand& command,
                                const std::function<LoopChanges()>& learnt) {
    if (command.kind == ViewerCommand::Kind::kSaveMesh) {
        mesh_writer_.reset();  // it has ended
        SaveMesh(command.path);
        if (mesh_writer_) mesh_writer_->Finish();
    }
    if (command.kind != ViewerCommand::Kind::kSaveScan) return;
    // One that was continued has a path that is only in its file.
    if (scan_ && scan_->failed() && !continued_) {
        paging_.reset();
        scan_.reset();
    }
    if (scan_) return notices_.Tell(ScanText("the scan is already saved: "));
    const std::string answer = StartScanNow(command.path);
    if (!scan_) return notices_.Tell(answer);
    scan_->AddLoops(learnt());
    scan_->Finish(stage_);
    if (!scan_->failed()) notices_.Tell("scan saved: " + command.path);
}

TriangleMesh FrameMapping::TakeMesh(Status& status, bool keep_map) {
    TriangleMesh mesh = MakeFinalMesh(status, keep_map);
    notices_.Tell(stage_.mesh_warning());
    return mesh;
}

TriangleMesh FrameMapping::MakeFinalMesh(Status& status, bool keep_map) {
    if (!paging_ || !paging_->paged()) return stage_.TakeMesh(keep_map);
    if (scan_->failed()) {
        const Status returned = paging_->ReturnAll();
        if (returned.ok()) return stage_.TakeMesh();
        if (status.ok()) status = returned;
        return {};
    }
    const std::string path = scan_->path();
    paging_.reset();
    scan_.reset();  // its checkpoint buffers would have to fit beside the mesh
    ReturnFreeMemory();
    return stage_.TakeStoredMesh(path, status);
}

}  // namespace tessera
