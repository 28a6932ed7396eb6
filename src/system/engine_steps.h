// Steps that both engines share.
#pragma once

#include <optional>
#include <string>

#include "optimize/loop_closer.h"
#include "system/mapping_stage.h"
#include "system/paging_stage.h"
#include "system/recorder_thread.h"

namespace tessera {

// Starts recording to a folder (written by `recorder`'s thread) or to FILE.oni (written by the
// source). Call before the source's first frame.
Status StartRecording(const std::string& path, const RecordConfig& config, FrameSource& source,
                      RecorderThread& recorder);

// Writes the current mesh. Returns a message for the user.
std::string SaveMesh(const MappingStage& mapping, const std::string& path);

// Starts a scan file in the middle of a run. `past` holds the run's frames so far. Sets `scan`
// unless it is already set. Returns a message for the user.
std::string SaveScan(const std::string& path, const SourceInfo& source, const RunConfig& config,
                     bool wait, std::vector<PathRecord>& past, std::optional<ScanStage>& scan);

// If the configuration has a memory limit, creates the paging stage for the map that is saved to
// `scan_path`.
Status StartPaging(const PipelineConfig& config, const PinholeCamera& camera,
                   const std::string& scan_path, bool wait, std::unique_ptr<PagingStage>& paging);

// Replaces the map by the corrected one in every stage that holds part of it. `paging` may be null.
void PutInPlace(LoopCloser::Correction correction, MappingStage& mapping,
                std::optional<ScanStage>& scan, PagingStage* paging);

// Call at the end, after ScanStage::Finish. Meshes the whole map, including its paged-out part.
// Releases the map, and may release `scan`. `paging` may be null. On error sets `status` and
// returns an empty mesh.
TriangleMesh TakeFinalMesh(MappingStage& mapping, std::optional<ScanStage>& scan,
                           PagingStage* paging, Status& status);

// For a thread that polls for user commands and for a stop signal, which cannot wake it.
void SleepBriefly();

}  // namespace tessera
