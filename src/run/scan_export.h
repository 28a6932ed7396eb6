// Exports from a scan file: its mesh as a run would write it, its frames as a folder, and its
// description for `tessera info`.
#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "scan/scan_content.h"
#include "system/run_config.h"

namespace tessera {

// The settings that the scan was created with, as far as this version knows them.
RunConfig ConfigOf(const ScanMeta& meta);

// Includes labels if the scan has them. Uses the meshing settings that the scan was created with,
// as far as this version knows them. Takes the map.
Result<TriangleMesh> MeshOfScan(ScanContent& scan);

// Writes the stored raw frames to a new folder (TUM layout). Where the clock starts again, as in
// another session, the frames go on in a folder of their own: FOLDER_2 and so on. Damaged frames
// and those without colour are left out. Returns what the user should know of both; usually
// nothing. An error if there are no frames; it says how to keep them.
Result<std::vector<std::string>> ExportFrames(const std::string& scan_path,
                                              const std::string& folder);

// A few lines of text. Reads and checks the whole file.
Result<std::string> DescribeScan(const std::string& path);

}  // namespace tessera
