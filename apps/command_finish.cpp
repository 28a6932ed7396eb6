// tessera finish: a clean, textured model from a scan or a run.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "box_option.h"
#include "command.h"
#include "finish/decimate.h"
#include "finish/shell.h"
#include "finished_model.h"
#include "io/file.h"
#include "io/mesh_writers.h"
#include "run/finish_run.h"
#include "stop_signal.h"

namespace tessera {
namespace {

struct FinishArguments {
    FinishRequest request;
    std::string out;
    std::vector<double> box;
    bool keep_triangles = false, keep_flaps = false;
    double watertight_m = 0;
};

void Print(const FinishReport& r) {
    fmt::print("{} triangles; {} islands of {} triangles removed ({:.3f} m2)\n", r.triangles_before,
               r.islands.islands, r.islands.triangles, r.islands.area_m2);
    fmt::print("flaps: {} triangles removed that frames look through, {} of the fringe\n",
               r.flaps.triangles, r.flaps.fringe);
    const ClosedHoles& h = r.holes;
    fmt::print(
        "holes: {} closed ({:.3f} m2, {:.0f} % of their border); open: {} larger, {} uneven, {} "
        "folded, {} that frames look "
        "through\n",
        h.closed, h.area_m2, 100 * h.closed_border_m / std::max(h.hole_border_m, 1e-9), h.large,
        h.uneven, h.folded, h.through);
    for (const LevelReport& level : r.levels)
        fmt::print(
            "{}: {} triangles, surface moved by up to about {:.1f} mm; texture {} x {}, texels of "
            "{:.1f} mm in {} charts, {:.1f} % of it seen\n",
            &level == &r.levels.front() ? "model" : "lower level", level.triangles,
            1000 * level.error_m, level.width, level.height, 1000 * level.texel_m, level.charts,
            100 * level.seen_share);
    fmt::print("texture from {} of the {} frames that were read for it\n", r.views, r.frames);
}

Status WriteShell(const FinishArguments& a, const FinishedModel& finished) {
    if (a.watertight_m <= 0) return Status::Ok();
    const Shell shell = MakeShell(finished.surface, a.watertight_m);
    fmt::print("watertight.obj: {} closed pieces, {} open ones as plates\n", shell.closed_pieces,
               shell.open_pieces);
    return WriteObj(a.out + "/watertight.obj", shell.mesh);
}

Status Finish(const FinishArguments& a) {
    FinishRequest request = a.request;
    const auto box = BoxOf(a.box);
    if (!box.ok()) return box.status();
    request.box_m = box.value();
    request.options.clean.remove_flaps = !a.keep_flaps;
    if (a.keep_triangles) request.options.clean.decimation_share = 1;
    if (!DecimationAvailable() && request.options.lower_levels > 0)
        return Status::Error(fmt::format("--levels: decimation is {}", kDecimationUnavailable));
    if (!a.keep_triangles && !DecimationAvailable())
        fmt::print(stderr, "tessera: all triangles are kept: decimation is {}\n",
                   kDecimationUnavailable);
    const std::atomic<bool>& stop = StopOnSignal();
    const bool terminal = isatty(STDERR_FILENO) == 1;
    // Made when the input was read, and before the work that it is for.
    std::optional<Status> folder;
    const auto progress = [&](const char* step, double share) {
        if (!folder) folder = PrepareOutputFolder(a.out);
        if (!folder->ok()) return false;
        if (terminal) fmt::print(stderr, "\r{:3.0f} % {:<12}", 100 * share, step);
        return !stop.load();
    };
    const Result<FinishedModel> finished = FinishRun(request, progress);
    if (terminal) fmt::print(stderr, "\r{:<18}\r", "");
    if (folder && !folder->ok()) return *folder;
    if (!finished.ok()) return finished.status();
    Print(finished.value().report);
    if (const auto made = std::ssize(finished.value().lower_levels);
        made < request.options.lower_levels)
        fmt::print("{} of {} lower levels: the next would have fewer than 4 triangles\n", made,
                   request.options.lower_levels);
    if (Status status = WriteFinishedModel(a.out, finished.value(), a.request.level); !status.ok())
        return status;
    return WriteShell(a, finished.value());
}

}  // namespace

void AddFinishCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<FinishArguments>();
    CLI::App* command = app.add_subcommand(
        "finish", "Make a clean, textured model of a scan file or a run: model.glb, model.obj");
    command
        ->add_option("INPUT", a->request.input,
                     "FILE.scan with raw frames (scan.frames), or the folder of a run")
        ->required();
    command->add_option("--out", a->out, "Folder for the model")->required()->type_name("DIR");
    command
        ->add_option("--source", a->request.source,
                     "The run's recording, if it has moved since (default: as in run.json)")
        ->type_name("SOURCE");
    command
        ->add_option("--island", a->request.options.clean.least_island_m2,
                     "Remove loose pieces of less surface than this, square metres")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command
        ->add_option("--smoothing", a->request.options.clean.smoothing_rounds,
                     "Rounds of smoothing; 0 leaves the surface as it was fused")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        ->add_option("--close-holes", a->request.options.clean.hole_m,
                     "Close holes up to this size, metres; 0 leaves all open")
        ->check(CLI::Range(0.0, 2.0))
        ->capture_default_str();
    command->add_flag("--keep-flaps", a->keep_flaps,
                      "Keep surface that frames look through, and the fringe of the border");
    command
        ->add_option("--error", a->request.options.clean.decimation_error_m,
                     "Remove triangles while the surface moves by less than this, metres")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_flag("--level", a->request.level,
                      "z up and the floor at z = 0, instead of the first camera's axes");
    AddBoxOption(*command, a->box, "Only what lies in this box, in the axes of --level if given");
    command->add_flag("--keep-triangles", a->keep_triangles, "Remove no triangles");
    command
        ->add_option("--levels", a->request.options.lower_levels,
                     "Lower levels of detail, model_lod1.glb ...: each a quarter of the triangles")
        ->check(CLI::Range(0, kMostLowerLevels))
        ->capture_default_str();
    command
        ->add_option("--watertight", a->watertight_m,
                     "Write watertight.obj, too: open surfaces become plates so thick, metres")
        ->check(CLI::Range(0.0001, 1.0));
    command
        ->add_option("--texel", a->request.options.texture.texel_m,
                     "Side of a texel on the surface, metres; larger if the texture does not fit")
        ->check(CLI::Range(0.0002, 0.1))
        ->capture_default_str();
    command
        ->add_option("--texture", a->request.options.texture.texture_side,
                     "Largest side of the texture, texels")
        ->check(CLI::Range(256, 8192))
        ->capture_default_str();
    command->callback([a, &context] { context.exit_code = ExitCode(Finish(*a)); });
}

}  // namespace tessera
