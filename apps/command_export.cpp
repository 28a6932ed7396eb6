// tessera export: out of a scan file, or a finished run's folder, the files that other programs read.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "command.h"
#include "io/mesh_io.h"
#include "io/mesh_writers.h"
#include "io/trajectory.h"
#include "system/scan_export.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::string input, mesh, cloud, trajectory, frames;

    bool NeedsMesh() const { return !mesh.empty() || !cloud.empty(); }
};

// What is asked for, of either kind of input.
struct Content {
    TriangleMesh mesh;
    std::vector<StampedPose> path;
};

Result<Content> FromScan(const Arguments& a) {
    Result<ScanContent> scan = ReadScan(a.input, {.map = a.NeedsMesh()});
    if (!scan.ok()) return scan.status();
    Content content;
    content.path = scan.value().Path();
    if (!a.NeedsMesh()) return content;
    Result<TriangleMesh> mesh = MeshOfScan(scan.value());
    if (!mesh.ok()) return mesh.status();
    content.mesh = std::move(mesh.value());
    return content;
}

Result<Content> FromRun(const Arguments& a) {
    Content content;
    if (!a.frames.empty()) return Status::Error(a.input + ": a run's folder has no raw frames; a scan file may have");
    if (a.NeedsMesh()) {
        Result<TriangleMesh> mesh = ReadPly(a.input + "/mesh.ply");
        if (!mesh.ok()) return mesh.status();
        content.mesh = std::move(mesh.value());
    }
    if (!a.trajectory.empty()) {
        Result<Trajectory> trajectory = ReadTrajectory(a.input + "/trajectory.txt");
        if (!trajectory.ok()) return trajectory.status();
        content.path = std::move(trajectory.value().poses);
    }
    return content;
}

Status Export(const Arguments& a) {
    if (!a.NeedsMesh() && a.trajectory.empty() && a.frames.empty())
        return Status::Error("nothing to export; give --mesh, --cloud, --trajectory or --frames");
    const Result<MeshFormat> format = MeshFormatOf(a.mesh.empty() ? "mesh.ply" : a.mesh);
    if (!format.ok()) return Status::Error("--mesh " + format.message());
    std::error_code ignored;
    const bool folder = fs::is_directory(a.input, ignored);
    const Result<Content> content = folder ? FromRun(a) : FromScan(a);
    if (!content.ok()) return content.status();
    const TriangleMesh& mesh = content.value().mesh;
    if (!a.mesh.empty())
        if (Status status = format.value().write(a.mesh, mesh); !status.ok()) return status;
    if (!a.cloud.empty())
        if (Status status = WritePlyCloud(a.cloud, mesh); !status.ok()) return status;
    if (!a.trajectory.empty())
        if (Status status = WriteTrajectory(a.trajectory, content.value().path); !status.ok()) return status;
    return a.frames.empty() ? Status::Ok() : ExportFrames(a.input, a.frames);
}

}  // namespace

void AddExportCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("export", "Write a scan file's or a run's mesh, path or raw frames as other files");
    command->add_option("INPUT", a->input, "FILE.scan, or a run's folder")->required();
    command->add_option("--mesh", a->mesh, "Coloured mesh, metres; by extension: .ply, .obj, .glb")->type_name("FILE");
    command->add_option("--cloud", a->cloud, "The mesh's vertices as a point cloud, .ply")->type_name("FILE");
    command->add_option("--trajectory", a->trajectory, "Camera path, TUM format")->type_name("FILE");
    command->add_option("--frames", a->frames, "New folder for the raw frames that a scan holds, TUM layout")->type_name("DIR");
    command->callback([a, &context] { context.exit_code = ExitCode(Export(*a)); });
}

}  // namespace tessera
