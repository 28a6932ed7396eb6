#include "run/scanned.h"

#include <fmt/format.h>

#include <filesystem>

#include "io/mesh_io.h"
#include "run/scan_export.h"
#include "scan/scan_content.h"

namespace tessera {

Result<Scanned> ReadRunFolder(const std::string& folder) {
    for (const char* name : {"mesh.ply", "trajectory.txt"})
        if (std::error_code ignored; !std::filesystem::exists(folder + "/" + name, ignored))
            return Status::Error(fmt::format(
                "{}: has no {}; give the folder that tessera run --out wrote", folder, name));
    Result<TriangleMesh> mesh = ReadPly(folder + "/mesh.ply");
    if (!mesh.ok()) return mesh.status();
    Result<Trajectory> path = ReadTrajectory(folder + "/trajectory.txt");
    if (!path.ok()) return path.status();
    return Scanned{std::move(mesh.value()), std::move(path.value().poses)};
}

Result<Scanned> ReadScanFile(const std::string& path) {
    Result<ScanContent> scan = ReadScanToShow(path, {});
    if (!scan.ok()) return scan.status();
    Result<TriangleMesh> mesh = MeshOfScan(scan.value());
    if (!mesh.ok()) return mesh.status();
    return Scanned{std::move(mesh.value()), scan.value().Path()};
}

Result<Scanned> ReadScanOrMesh(const std::string& path) {
    if (path.ends_with(".scan")) return ReadScanFile(path);
    Result<TriangleMesh> mesh = ReadPly(path);
    if (!mesh.ok()) return mesh.status();
    return Scanned{std::move(mesh.value()), {}};
}

}  // namespace tessera
