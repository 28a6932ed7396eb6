// Out of a scan file: its mesh as a run would have written it, its frames as a folder, and what
// `tessera info` says of it.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/status.h"
#include "scan/scan_content.h"

namespace tessera {

// With labels where the scan has them. Meshing's settings are the ones that the scan was begun
// with, where this version knows them. Takes the map.
Result<TriangleMesh> MeshOfScan(ScanContent& scan);

// The same of a file; `path`, if not null, gets the poses.
Result<TriangleMesh> MeshOfScanFile(const std::string& scan_path,
                                    std::vector<Eigen::Isometry3d>* path);

// The stored raw frames as a new folder (TUM layout). An error if there are none; it says how to
// keep them.
Status ExportFrames(const std::string& scan_path, const std::string& folder);

// Some lines of text. Everything in the file is read and checked.
Result<std::string> DescribeScan(const std::string& path);

}  // namespace tessera
