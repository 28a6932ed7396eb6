#include "system/engine_steps.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "io/mesh_io.h"
#include "system/timings.h"

namespace tessera {

Status StartRecording(const std::string& path, const RecordConfig& config, FrameSource& source,
                      RecorderThread& recorder) {
    if (path.ends_with(".oni"))
        return source.RecordTo(path, config.colour == RecordConfig::Colour::kPng);
    return recorder.Start(path);
}

std::string SaveMesh(const MappingStage& mapping, const std::string& path) {
    const TriangleMesh mesh = mapping.Mesh();
    if (mesh.triangles.empty()) return "no surface to save yet";
    const Status status = WritePly(path, mesh);
    if (!status.ok()) return status.message();
    return fmt::format("saved {}: {} triangles", path, mesh.triangles.size());
}

std::string SaveScan(const std::string& path, const SourceInfo& source, const RunConfig& config,
                     bool wait, std::vector<PathRecord>& past, std::optional<ScanStage>& scan) {
    if (scan) return "the scan is already being saved: " + scan->path();
    if (config.loops.refine_calibration)
        return "cannot save a scan with calibration.refine: its frames would have two different "
               "calibrations";
    Result<ScanPlan> plan = BeginScan(path, source, config);
    if (!plan.ok()) return plan.message();
    scan.emplace(std::move(plan.value()), config.scan, wait, config.loops.enabled);
    scan->AddPast(std::exchange(past, {}));
    return "scan saved; it is kept up to date from now on: " + path;
}

Status StartPaging(const PipelineConfig& config, const PinholeCamera& camera,
                   const std::string& scan_path, bool wait, std::unique_ptr<PagingStage>& paging) {
    if (!config.paging.enabled()) return Status::Ok();
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(scan_path);
    if (!reader.ok()) return reader.status();
    paging = std::make_unique<PagingStage>(
        config, camera, std::make_unique<Pager>(std::move(reader.value())), wait);
    return Status::Ok();
}

void PutInPlace(LoopCloser::Correction correction, MappingStage& mapping,
                std::optional<ScanStage>& scan, PagingStage* paging) {
    mapping.Replace(std::move(correction.map), std::move(correction.labels));
    if (paging == nullptr) return;
    paging->Replaced(correction.T_new_old, static_cast<const RebuildPaging&>(*correction.pager),
                     mapping, *scan);
}

TriangleMesh TakeFinalMesh(MappingStage& mapping, std::optional<ScanStage>& scan,
                           PagingStage* paging, Status& status) {
    if (paging == nullptr || !paging->paged()) return mapping.TakeMesh();
    if (scan->failed()) {
        const Status returned = paging->ReturnAll(mapping, *scan);
        if (returned.ok()) return mapping.TakeMesh();
        if (status.ok()) status = returned;
        return {};
    }
    const std::string path = scan->path();
    scan.reset();  // its checkpoint buffers would have to fit beside the mesh
    ReturnFreeMemory();
    return mapping.TakeStoredMesh(path, status);
}

void SleepBriefly() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }

}  // namespace tessera
