// tessera finish: a clean, textured model from a scan or a run.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "export/level.h"
#include "finish/decimate.h"
#include "io/file.h"
#include "io/image_io.h"
#include "render/mesh_picture.h"
#include "run/finish_run.h"
#include "stop_signal.h"

namespace tessera {
namespace {

struct Arguments {
    FinishRequest request;
    std::string out;
    bool keep_triangles = false;
};

void Print(const FinishReport& r, const TexturedMesh& model) {
    fmt::print("{} triangles; {} islands of {} triangles removed ({:.3f} m2)\n", r.triangles_before,
               r.islands.islands, r.islands.triangles, r.islands.area_m2);
    if (r.decimation_error_m > 0)
        fmt::print("{} triangles left; surface moved by up to about {:.1f} mm\n",
                   model.mesh.triangles.size(), 1000 * r.decimation_error_m);
    fmt::print(
        "texture: {} x {}, texels of {:.1f} mm in {} charts; {} of {} frames, which show {:.1f} % "
        "of it\n",
        model.texture.width(), model.texture.height(), 1000 * r.texel_m, r.charts, r.views,
        r.frames, 100 * r.seen_share);
}

Status Finish(const Arguments& a) {
    FinishRequest request = a.request;
    if (a.keep_triangles) request.options.decimation_share = 1;
    if (!a.keep_triangles && !DecimationAvailable())
        fmt::print(stderr, "tessera: all triangles are kept: decimation is {}\n",
                   kDecimationUnavailable);
    if (Status status = PrepareOutputFolder(a.out); !status.ok()) return status;
    const std::atomic<bool>& stop = StopOnSignal();
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const auto progress = [&](const char* step, double share) {
        if (terminal) fmt::print(stderr, "\r{:3.0f} % {:<12}", 100 * share, step);
        return !stop.load();
    };
    const Result<FinishedModel> finished = FinishRun(request, progress);
    if (terminal) fmt::print(stderr, "\r{:<18}\r", "");
    if (!finished.ok()) return finished.status();
    const TexturedMesh& model = finished.value().model;
    Print(finished.value().report, model);
    const MeshView view = ChooseView(model.mesh);
    TexturedMesh upright = model;
    if (request.level) upright.mesh = WithYDown(std::move(upright.mesh));
    for (Status status :
         {WriteTexturedGlb(a.out + "/model.glb", upright),
          WriteTexturedObj(a.out + "/model.obj", model),
          WriteColourImage(a.out + "/preview.png",
                           RenderTextured(model, view.camera, view.T_world_camera))})
        if (!status.ok()) return status;
    return Status::Ok();
}

}  // namespace

void AddFinishCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<Arguments>();
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
        ->add_option("--island", a->request.options.least_island_m2,
                     "Remove loose pieces of less surface than this, square metres")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command
        ->add_option("--smoothing", a->request.options.smoothing_rounds,
                     "Rounds of smoothing; 0 leaves the surface as it was fused")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        ->add_option("--error", a->request.options.decimation_error_m,
                     "Remove triangles while the surface moves by less than this, metres")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_flag("--level", a->request.level,
                      "z up and the floor at z = 0, instead of the first camera's axes");
    command->add_flag("--keep-triangles", a->keep_triangles, "Remove no triangles");
    command
        ->add_option("--texel", a->request.options.texel_m,
                     "Side of a texel on the surface, metres; larger if the texture does not fit")
        ->check(CLI::Range(0.0002, 0.1))
        ->capture_default_str();
    command
        ->add_option("--texture", a->request.options.texture_side,
                     "Largest side of the texture, texels")
        ->check(CLI::Range(256, 8192))
        ->capture_default_str();
    command->callback([a, &context] { context.exit_code = ExitCode(Finish(*a)); });
}

}  // namespace tessera
