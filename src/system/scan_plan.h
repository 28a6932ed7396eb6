// How a run uses a scan file, decided before the run starts: a new file, or an existing one to
// continue.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "scan/scan_content.h"
#include "system/run_config.h"

namespace tessera {

struct ScanPlan {
    std::unique_ptr<ScanFile> file;  // to write to; null: nothing is saved
    double depth_units_per_m = 5000;
    std::string source_name;
    std::optional<ScanContent> resumed;  // content to continue with; without a file: to stay in

    // The camera is only tracked in the scan's map. Nothing changes the map or the scan.
    bool only_localise() const { return resumed && !file; }
};

// Keys that are fixed by a resumed scan's file, because its blocks and frames were made with them.
// TakeScanKeys: call before --config and --set. Replaces the defaults by the file's values.
Status TakeScanKeys(const std::string& path, ConfigParameters& parameters);
// CheckScanKeys: call after them. The error names the key that contradicts the file.
Status CheckScanKeys(const std::string& path, ConfigParameters& parameters);

// Creates a file for this source and configuration. Error if the file exists.
Result<ScanPlan> BeginScan(const std::string& path, const SourceInfo& source, RunConfig config);
// Opens an existing file and checks all of it. `labels`: the run has labels. Error if the camera
// differs, or if the scan has labels and the run has none.
Result<ScanPlan> ResumeScan(const std::string& path, const SourceInfo& source,
                            const RunConfig& config, bool labels);

// Reads all of an existing file, to track a camera in its map without changing it. Error if the
// camera differs, or if nothing was tracked in the scan.
Result<ScanPlan> OpenToLocalise(const std::string& path, const SourceInfo& source,
                                const RunConfig& config);

// The part of a recorded source that the scan does not have yet. Count 0 if none is left. Of a file
// or folder any name will do.
FrameSelection RestOf(const FrameSelection& selection, const SourceInfo& source,
                      const ScanContent& resumed);

}  // namespace tessera
