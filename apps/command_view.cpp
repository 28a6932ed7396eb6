// tessera view: shows a mesh, or the folder of a finished run, in a window.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "command.h"
#include "core/printable.h"
#include "finished_model.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/openni_devices.h"
#include "io/trajectory.h"
#include "run/finish_run.h"
#include "run/open_source.h"
#include "run/run_source.h"
#include "run/scanned.h"
#include "semantics/objects_file.h"
#include "start_window.h"
#include "viz/measuring.h"
#include "viz/viewer.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

struct ViewRequest {
    std::string path, trajectory, screenshot;
    int width = 1280, height = 720;
};

// The files to read: the mesh, and the trajectory beside it if there is one.
struct Files {
    std::string mesh, trajectory, objects;
    std::string run;  // the folder of the run; empty: none
};

Result<Files> FindFiles(const ViewRequest& a) {
    std::error_code ignored;
    if (a.path.empty())
        return Status::Error("view: --screenshot and --trajectory need a PATH to show");
    Files files{a.path, a.trajectory, {}, {}};
    if (a.path.starts_with("synthetic:") || a.path.starts_with(kOpenniPrefix) ||
        a.path.ends_with(".oni") || a.path.ends_with(".klg"))
        return Status::Error(
            fmt::format("{}: is a source, not a result; use: tessera run {} --view", a.path,
                        ShellLine({a.path})));
    if (!fs::exists(a.path, ignored)) return Status::Error(a.path + ": no such file or folder");
    constexpr const char* kOpenIn = "Blender or f3d";
    if (a.path.ends_with(".glb") || a.path.ends_with(".obj"))
        return Status::Error(
            fmt::format("{}: is for other programs: open it in {}", a.path, kOpenIn));
    if (!fs::is_directory(a.path, ignored)) return files;
    const fs::path folder = a.path;
    files.mesh = (folder / "mesh.ply").string();
    for (const char* name : {"model.glb", "model.obj"})
        if (!fs::exists(files.mesh, ignored) && fs::exists(folder / name, ignored))
            return Status::Error(
                fmt::format("{}: holds a finished model: open {} in {}", a.path, name, kOpenIn));
    if (!fs::exists(files.mesh, ignored))
        return Status::Error(
            fmt::format("{}: has no mesh.ply, so it is not the folder of a run; to view a source, "
                        "use: tessera run {} --view",
                        a.path, ShellLine({a.path})));
    if (fs::exists(folder / "trajectory.txt", ignored)) {
        files.run = a.path;
        if (files.trajectory.empty()) files.trajectory = (folder / "trajectory.txt").string();
    }
    if (fs::exists(folder / "objects.json", ignored))
        files.objects = (folder / "objects.json").string();
    return files;
}

Result<ViewedModel> Read(const Files& files) {
    ViewedModel model;
    Result<Scanned> scanned = ReadScanOrMesh(files.mesh);
    if (!scanned.ok()) return scanned.status();
    model.mesh = std::move(scanned.value().mesh);
    if (model.mesh.triangles.empty()) return Status::Error(files.mesh + ": has no triangles");
    if (!files.objects.empty()) {
        Result<std::vector<MapObject>> objects = ReadObjects(files.objects);
        if (!objects.ok()) return objects.status();
        model.objects = std::move(objects.value());
    }
    std::vector<StampedPose> path = std::move(scanned.value().path);
    if (!files.trajectory.empty()) {
        Result<Trajectory> trajectory = ReadTrajectory(files.trajectory);
        if (!trajectory.ok()) return trajectory.status();
        path = std::move(trajectory.value().poses);
    }
    for (const StampedPose& pose : path) model.path.push_back(pose.T_world_camera);
    return model;
}

// What the run read. Empty if that is a camera.
FrameImages::Open SourceOf(const RunRecord& run) {
    if (run.source_name.empty() || IsLiveSource(run.source_name)) return {};
    return [run] { return OpenSourceOf(run); };
}

// `folder`, or with "_2" and so on, so that no finished model is in it.
std::string WithoutAModel(const std::string& folder) {
    std::string free = folder;
    std::error_code ignored;
    for (int i = 2;
         fs::exists(free + "/model.glb", ignored) || fs::exists(free + "/model.obj", ignored);)
        free = fmt::format("{}_{}", folder, i++);
    return free;
}

// As `tessera finish PATH --out MODEL`. Beside a scan file NAME.scan, MODEL is NAME_model. A model
// that is there already is kept: the new one is in MODEL_2, and so on.
BackgroundJob::Work FinishOf(const std::string& path) {
    return [path](const BackgroundJob::Progress& progress) -> Result<std::string> {
        const std::string model = fs::is_directory(path)
                                      ? (fs::path(path) / "model").string()
                                      : fs::path(path).replace_extension().string() + "_model";
        FinishRequest request;
        request.input = path;
        const Result<FinishedModel> finished = FinishRun(request, progress);
        if (!finished.ok()) return finished.status();
        const std::string out = WithoutAModel(model);
        if (Status status = PrepareOutputFolder(out); !status.ok()) return status;
        if (Status status = WriteFinishedModel(out, finished.value(), false); !status.ok())
            return status;
        return "made: " + out + "/model.glb, and model.obj";
    };
}

Status View(const ViewRequest& a, const CommandContext& context) {
    const Result<Files> files = FindFiles(a);
    if (!files.ok()) return files.status();
    Result<ViewedModel> model = Read(files.value());
    if (!model.ok()) return model.status();
    ViewerOptions options;
    if (!files.value().run.empty()) model.value().time_line = ReadTimeLine(files.value().run);
    if (const auto& line = model.value().time_line) {
        model.value().open_source = SourceOf(line->run);
        if (line->run.camera) options.camera = *line->run.camera;
    }
    if (!files.value().run.empty() || a.path.ends_with(".scan"))
        model.value().finish = FinishOf(a.path);
    options.window = context.window;
    options.title = a.path;
    std::error_code ignored;
    options.output_folder =
        fs::is_directory(a.path, ignored) ? a.path : fs::path(a.path).parent_path().string();
    if (options.output_folder.empty()) options.output_folder = ".";
    options.measurements = MeasurementsFile(a.path);
    options.screen.width = a.width;
    options.screen.height = a.height;
    Result<std::unique_ptr<Viewer>> viewer = Viewer::OpenModel(std::move(model.value()), options);
    if (!viewer.ok()) return viewer.status();
    if (!a.screenshot.empty()) return WriteColourImage(a.screenshot, viewer.value()->Picture());
    viewer.value()->Run();
    return Status::Ok();
}

}  // namespace

void AddViewCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<ViewRequest>();
    CLI::App* command = app.add_subcommand(
        "view", "Show a mesh or a run in a window, or choose there what to scan");
    command->add_option(
        "PATH", a->path,
        "PLY file, folder of a run (mesh.ply, trajectory.txt), or FILE.scan; without "
        "it, a window to choose what to scan or to show");
    command
        ->add_option("--trajectory", a->trajectory,
                     "TUM trajectory to draw, metres (default: that of the run)")
        ->type_name("FILE");
    command
        ->add_option("--screenshot", a->screenshot,
                     "Render once to this picture and exit; also needs a display")
        ->type_name("FILE.png");
    command->add_option("--width", a->width, "Width of the window in pixels")
        ->check(CLI::Range(320, 8192))
        ->capture_default_str();
    command->add_option("--height", a->height, "Height of the window in pixels")
        ->check(CLI::Range(240, 8192))
        ->capture_default_str();
    command->callback([a, &context] {
        if (a->path.empty() && a->screenshot.empty() && a->trajectory.empty())
            context.exit_code = StartInWindow(context, a->width, a->height);
        else
            context.Finish(View(*a, context));
    });
}

}  // namespace tessera
