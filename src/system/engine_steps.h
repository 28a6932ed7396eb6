// What both engines do the same way.
#pragma once

#include <optional>
#include <string>

#include "optimize/loop_closer.h"
#include "system/mapping_stage.h"
#include "system/paging_stage.h"
#include "system/recorder_thread.h"

namespace tessera {

// A folder by the recorder's thread, FILE.oni by the source itself; before the source's first
// frame.
Status StartRecording(const std::string& path, const RecordConfig& config, FrameSource& source,
                      RecorderThread& recorder);

// Writes the mesh as it is now; returns how that went, for a person.
std::string SaveMesh(const MappingStage& mapping, const std::string& path);

// A scan file in the midst of a run, `past` its frames so far: from now on there is a `scan`,
// unless there was one. Returns how that went, for a person.
std::string SaveScan(const std::string& path, const SourceInfo& source, const RunConfig& config,
                     bool wait, std::vector<PathRecord>& past, std::optional<ScanStage>& scan);

// Where the configuration has a memory limit: a stage for the map that is being saved to
// `scan_path`.
Status StartPaging(const PipelineConfig& config, const PinholeCamera& camera,
                   const std::string& scan_path, bool wait, std::unique_ptr<PagingStage>& paging);

// A corrected map in place of the one so far, wherever parts of it are. `paging` may be null.
void PutInPlace(LoopCloser::Correction correction, MappingStage& mapping,
                std::optional<ScanStage>& scan, PagingStage* paging);

// At the end, after ScanStage::Finish: of the map, wherever it is. `scan` and the map go; `paging`
// may be null. An error goes to `status`, the mesh is then empty.
TriangleMesh TakeFinalMesh(MappingStage& mapping, std::optional<ScanStage>& scan,
                           PagingStage* paging, Status& status);

// Of a thread that waits for a person's next wish and for a signal that cannot wake it.
void PauseBriefly();

}  // namespace tessera
