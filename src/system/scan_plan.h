// What is to be done with a scan file in a run, found out before the run begins: a new file, or one
// to go on with.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "scan/scan_content.h"
#include "system/run_config.h"

namespace tessera {

struct ScanPlan {
    std::unique_ptr<ScanFile> file;  // to write into; null: no scan
    double depth_units_per_m = 5000;
    std::optional<ScanContent> resumed;  // to go on with
};

// Keys that a scan's file decides when it is resumed: what its blocks and frames were made with.
// A configuration to start from, before --config and --set: the keys of the file in place of the
// defaults.
Status TakeScanKeys(const std::string& path, ConfigParameters& parameters);
// After them: an error that names the key which contradicts the file.
Status CheckScanKeys(const std::string& path, ConfigParameters& parameters);

// A new file for this source and configuration. Refused if it exists.
Result<ScanPlan> BeginScan(const std::string& path, const SourceInfo& source, RunConfig config);
// An existing one, all of it checked. `labels`: the run has labels. Refused: another camera, a scan
// with labels without.
Result<ScanPlan> ResumeScan(const std::string& path, const SourceInfo& source,
                            const RunConfig& config, bool labels);

// Of a recorded source that the scan was made of: the part that is still to come. Count 0 if
// nothing is.
FrameSelection RestOf(const FrameSelection& selection, const SourceInfo& source,
                      const ScanContent& resumed);

}  // namespace tessera
