// tessera export: writes a scan file or the folder of a finished run in the formats of other
// programs.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <numbers>
#include <utility>

#include "box_option.h"
#include "command.h"
#include "export/colmap_writer.h"
#include "export/image_set.h"
#include "export/level.h"
#include "export/transforms_json.h"
#include "export/vdb_writer.h"
#include "finish/crop.h"
#include "io/mesh_io.h"
#include "io/mesh_writers.h"
#include "io/trajectory.h"
#include "run/scan_export.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
    std::string input, mesh, cloud, grid, trajectory, kitti, frames, colmap;
    std::vector<double> box;
    bool level = false;

    bool WantsTransforms() const { return fs::path(frames).extension() == ".json"; }
    bool NeedsMesh() const {
        return level || !box.empty() || !mesh.empty() || !cloud.empty() || !colmap.empty() ||
               WantsTransforms();
    }
    bool NeedsPath() const { return level || !trajectory.empty() || !kitti.empty(); }
    // Whether an output needs data that only a scan file has.
    bool NeedsScan() const { return !grid.empty() || NeedsFrames(); }
    bool NeedsFrames() const { return !frames.empty() || !colmap.empty(); }
    // Whether an output takes its first points from the mesh, of which --box leaves nothing out.
    bool NeedsWholeMesh() const { return !colmap.empty() || WantsTransforms(); }
};

// The requested data, from either kind of input.
struct Content {
    TriangleMesh mesh;
    std::vector<StampedPose> path;
    double disparity_offset_per_m = 0;  // by which the mesh's depth differs from the raw frames'
};

Result<Content> FromScan(const ExportArguments& a) {
    if (a.NeedsFrames())  // check before anything is written
        if (const auto frames = PosedFrames::Open(a.input); !frames.ok()) return frames.status();
    Result<ScanContent> scan = ReadScanToShow(a.input, {.map = a.NeedsMesh() || !a.grid.empty()});
    if (!scan.ok()) return scan.status();
    Content content;
    content.path = scan.value().Path();
    content.disparity_offset_per_m =
        ConfigOf(scan.value().meta).pipeline.frame.disparity_offset_per_m;
    if (!a.grid.empty())
        if (Status status = WriteVdb(a.grid, *scan.value().map); !status.ok()) return status;
    if (!a.NeedsMesh()) return content;
    Result<TriangleMesh> mesh = MeshOfScan(scan.value());
    if (!mesh.ok()) return mesh.status();
    content.mesh = std::move(mesh.value());
    return content;
}

Result<Content> FromRun(const ExportArguments& a) {
    Content content;
    if (a.NeedsMesh()) {
        Result<TriangleMesh> mesh = ReadPly(a.input + "/mesh.ply");
        if (!mesh.ok()) return mesh.status();
        content.mesh = std::move(mesh.value());
    }
    if (a.NeedsPath()) {
        Result<Trajectory> trajectory = ReadTrajectory(a.input + "/trajectory.txt");
        if (!trajectory.ok()) return trajectory.status();
        content.path = std::move(trajectory.value().poses);
    }
    return content;
}

// Checks the arguments before anything is read or written.
Status Check(const ExportArguments& a, bool is_run) {
    if (!a.NeedsMesh() && !a.NeedsPath() && !a.NeedsScan())
        return Status::Error(
            "nothing to export; give --mesh, --cloud, --grid, --trajectory, --kitti, --frames or "
            "--colmap");
    if (is_run && a.NeedsScan())
        return Status::Error(a.input +
                             ": the folder of a run has no map and no raw frames; --grid, --frames "
                             "and --colmap need a FILE.scan");
    if (a.level && a.NeedsScan())
        return Status::Error(
            "--level: turns meshes, clouds and paths only; leave --grid, --frames and --colmap "
            "out");
    if (!a.box.empty() && a.mesh.empty() && a.cloud.empty())
        return Status::Error("--box: crops meshes and clouds; give --mesh or --cloud");
    if (!a.mesh.empty())
        if (const Result<MeshFormat> format = MeshFormatOf(a.mesh); !format.ok())
            return Status::Error("--mesh " + format.message());
    if (!a.cloud.empty() && fs::path(a.cloud).extension() != ".ply")
        return Status::Error("--cloud " + a.cloud +
                             ": a point cloud is written as .ply; use this extension");
    if (!a.grid.empty() && fs::path(a.grid).extension() != ".vdb")
        return Status::Error("--grid " + a.grid +
                             ": a volume is written as .vdb; use this extension");
    if (!a.grid.empty() && !VdbAvailable())
        return Status::Error("--grid " + a.grid + ": .vdb is " + kVdbUnavailable);
    return Status::Ok();
}

// Prints the notes.
Status Tell(const Result<std::vector<std::string>>& notes) {
    if (!notes.ok()) return notes.status();
    for (const std::string& note : notes.value())
        fmt::print(stderr, "tessera: note: {}\n", Printable(note));
    return Status::Ok();
}

// `shown` is the mesh in the box.
Status Write(const ExportArguments& a, const Content& content, const TriangleMesh& shown) {
    if (!a.mesh.empty())
        if (Status status = MeshFormatOf(a.mesh).value().write(
                a.mesh,
                a.level && fs::path(a.mesh).extension() == ".glb" ? WithYDown(shown) : shown);
            !status.ok())
            return status;
    if (!a.cloud.empty())
        if (Status status = WritePlyCloud(a.cloud, shown); !status.ok()) return status;
    if (!a.trajectory.empty())
        if (Status status = WriteTrajectory(a.trajectory, content.path); !status.ok())
            return status;
    if (!a.kitti.empty())
        if (Status status = WriteKittiPoses(a.kitti, content.path); !status.ok()) return status;
    if (!a.colmap.empty())
        if (Status status = Tell(WriteColmap(a.input, content.mesh, a.colmap)); !status.ok())
            return status;
    if (a.WantsTransforms())
        return Tell(
            WriteTransforms(a.input, content.mesh, a.frames, content.disparity_offset_per_m));
    return a.frames.empty() ? Status::Ok() : Tell(ExportFrames(a.input, a.frames));
}

Status Turn(const std::string& input, Content& content) {
    const Result<Level> level = FindLevel(content.mesh, content.path);
    if (!level.ok()) return Status::Error("--level: " + input + ": " + level.message());
    const Level& found = level.value();
    fmt::print(
        "level: the first camera was tilted by {:.2f} degrees; taken from {} vertices, "
        "{:.1f} mm about their plane\n",
        found.tilt_rad * 180 / std::numbers::pi, found.points, 1000 * found.roughness_m);
    MakeLevel(found, content.mesh, content.path);
    return Status::Ok();
}

Status Export(const ExportArguments& a) {
    std::error_code ignored;
    const bool is_run = fs::is_directory(a.input, ignored);
    if (Status status = Check(a, is_run); !status.ok()) return status;
    const auto box = BoxOf(a.box);
    if (!box.ok()) return box.status();
    Result<Content> content = is_run ? FromRun(a) : FromScan(a);
    if (!content.ok()) return content.status();
    if (a.level)
        if (Status status = Turn(a.input, content.value()); !status.ok()) return status;
    if (!box.value()) return Write(a, content.value(), content.value().mesh);
    TriangleMesh shown =
        a.NeedsWholeMesh() ? content.value().mesh : std::move(content.value().mesh);
    if (Status status = CropMesh(*box.value(), shown); !status.ok())
        return Status::Error("--box: " + a.input + ": " + status.message());
    return Write(a, content.value(), shown);
}

}  // namespace

void AddExportCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<ExportArguments>();
    CLI::App* command = app.add_subcommand(
        "export", "Export the mesh, map, path or raw frames of a scan file or a run");
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        command->add_option(name, value, what)->type_name(type);
    };
    command
        ->add_option("INPUT", a->input,
                     "FILE.scan, or the folder of a run (mesh, cloud and path only)")
        ->required();
    add("--mesh", a->mesh, "Coloured mesh, metres; the extension sets the format: .ply, .obj, .glb",
        "FILE");
    add("--cloud", a->cloud, "The mesh's vertices as a point cloud, .ply", "FILE");
    add("--grid", a->grid, "Signed distance (metres) and colour as OpenVDB grids, .vdb", "FILE");
    add("--trajectory", a->trajectory, "Camera path, TUM format", "FILE");
    add("--kitti", a->kitti, "Camera path, KITTI format; time stamps are written to FILE.times",
        "FILE");
    add("--frames", a->frames,
        "Raw frames stored in the scan: a new folder (TUM layout), or FILE.json for nerfstudio and "
        "instant-ngp, with images/ and depth/ beside it",
        "DIR|FILE.json");
    add("--colmap", a->colmap,
        "Raw frames with their poses and points of the mesh, as a COLMAP text model; images in "
        "images/",
        "DIR");
    command->add_flag("--level", a->level,
                      "z up and the floor at z = 0 for --mesh, --cloud, --trajectory and --kitti, "
                      "instead of the first camera's axes; found from the floor");
    AddBoxOption(*command, a->box,
                 "Only what lies in this box, for --mesh and --cloud, in the axes of --level if "
                 "given");
    command->callback([a, &context] { context.exit_code = ExitCode(Export(*a)); });
}

}  // namespace tessera
