// tessera eval: measures the error of a result against ground truth.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>

#include "command.h"
#include "eval/alignment.h"
#include "eval/ate.h"
#include "eval/drift.h"
#include "eval/mesh_error.h"
#include "eval/plot.h"
#include "eval/rpe.h"
#include "eval_objects.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "render/mesh_picture.h"
#include "run_text.h"

namespace tessera {
namespace {

struct EvalArguments {
    std::string reference, estimate, json, picture;
    std::vector<std::string> align;  // trajectories of the reference and of the run
};

// Reads both trajectories. Prints the reader's notes on stderr.
Result<std::pair<Trajectory, Trajectory>> ReadBoth(const std::string& reference,
                                                   const std::string& estimate) {
    Result<Trajectory> a = ReadTrajectory(reference);
    if (!a.ok()) return a.status();
    Result<Trajectory> b = ReadTrajectory(estimate);
    if (!b.ok()) return b.status();
    for (const Trajectory* trajectory : {&a.value(), &b.value()})
        for (const std::string& note : trajectory->notes)
            fmt::print(stderr, "tessera: note: {}\n", Printable(note));
    return std::pair{std::move(a.value()), std::move(b.value())};
}

Status EvalAte(const EvalArguments& a) {
    const auto both = ReadBoth(a.reference, a.estimate);
    if (!both.ok()) return both.status();
    const auto& [reference, estimate] = both.value();
    const Result<AteResult> ate =
        EvaluateAte(reference.poses, estimate.poses, {.frames = FramesOfRun(a.estimate)});
    if (!ate.ok()) return Status::Error(a.estimate + ": " + ate.message());
    fmt::print("{}", AteText(ate.value()));
    if (!a.json.empty())
        if (Status status = WriteTextFile(a.json, AteJson(ate.value())); !status.ok())
            return status;
    return a.picture.empty() ? Status::Ok()
                             : WriteColourImage(a.picture, PlotAte(ate.value(), a.estimate));
}

Status EvalRpe(const EvalArguments& a, const RpeOptions& options) {
    const auto both = ReadBoth(a.reference, a.estimate);
    if (!both.ok()) return both.status();
    const auto& [reference, estimate] = both.value();
    const Result<RpeResult> rpe = EvaluateRpe(reference.poses, estimate.poses, options);
    if (!rpe.ok()) return Status::Error(a.estimate + ": " + rpe.message());
    const RpeResult& r = rpe.value();
    const double degrees = 180 / std::numbers::pi;
    fmt::print(
        "RPE over {:.3g} s: translation RMSE {:.4f} m (median {:.4f}, max {:.4f}), rotation RMSE "
        "{:.3f} deg (median "
        "{:.3f}, max {:.3f}), {} pairs, no alignment\n",
        r.delta_s, r.trans_m.rmse, r.trans_m.median, r.trans_m.max, degrees * r.rot_rad.rmse,
        degrees * r.rot_rad.median, degrees * r.rot_rad.max, r.pairs.size());
    return a.json.empty() ? Status::Ok() : WriteTextFile(a.json, RpeJson(r));
}

// Where a run left its path as tracked, if it corrected it.
std::string TrackedBeside(const std::string& estimate) {
    const auto path = std::filesystem::path(estimate).parent_path() / "trajectory_tracked.txt";
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ? path.string() : estimate;
}

Status EvalDrift(const EvalArguments& a, const std::string& tracked) {
    const auto both = ReadBoth(a.reference, a.estimate);
    if (!both.ok()) return both.status();
    const auto& [reference, estimate] = both.value();
    const Result<DriftResult> drift = EvaluateDrift(reference.poses, estimate.poses);
    if (!drift.ok()) return Status::Error(a.estimate + ": " + drift.message());
    fmt::print("{}", DriftText(drift.value()));
    if (!a.json.empty())
        if (Status status = WriteTextFile(a.json, DriftJson(drift.value())); !status.ok())
            return status;
    if (a.picture.empty()) return Status::Ok();
    const std::string before = tracked.empty() ? TrackedBeside(a.estimate) : tracked;
    const Result<Trajectory> path = ReadTrajectory(before);
    if (!path.ok()) return path.status();
    const Result<ColourImage> plot =
        PlotCorrection(reference.poses, path.value().poses, estimate.poses, a.estimate);
    if (!plot.ok()) return Status::Error(before + ": " + plot.message());
    return WriteColourImage(a.picture, plot.value());
}

Status PaintErrors(const std::string& path, TriangleMesh mesh, const MeshErrorResult& error) {
    const double max_m = std::max(1e-3, 3 * error.accuracy_m.mean);
    mesh.colours = ErrorColours(error.distances_m, max_m);
    const MeshView view = ChooseView(mesh);
    RenderStyle style;
    style.shading = RenderStyle::Shading::kLitColour;
    ColourImage image = RenderMesh(mesh, view.camera, view.T_world_camera, style);
    DrawErrorScale(max_m, image);
    return WriteColourImage(path, image);
}

Status EvalMesh(const EvalArguments& a) {
    const Result<TriangleMesh> reference = ReadPly(a.reference);
    if (!reference.ok()) return reference.status();
    const Result<TriangleMesh> mesh = ReadPly(a.estimate);
    if (!mesh.ok()) return mesh.status();
    if (!a.picture.empty() && mesh.value().triangles.empty())
        return Status::Error(a.estimate + ": has no triangles to draw; leave --picture out");
    MeshErrorOptions options;
    if (!a.align.empty()) {
        const auto both = ReadBoth(a.align[0], a.align[1]);
        if (!both.ok()) return both.status();
        const auto alignment =
            AlignTrajectories(both.value().first.poses, both.value().second.poses);
        if (!alignment.ok()) return Status::Error(a.align[1] + ": " + alignment.message());
        if (!alignment.value().warning.empty())
            fmt::print(stderr, "tessera: note: {}\n", alignment.value().warning);
        options.T_reference_mesh = alignment.value().T_reference_estimate;
    }
    const Result<MeshErrorResult> result =
        MeasureMeshError(mesh.value(), reference.value(), options);
    if (!result.ok()) return Status::Error(a.estimate + ": " + result.message());
    const MeshErrorResult& r = result.value();
    fmt::print(
        "surface error: mean {:.4f} m, std {:.4f}, RMSE {:.4f}, max {:.4f}; {:.1f} % of the "
        "reference within 5 cm; "
        "{} vertices, vertex to triangle, {}\n",
        r.accuracy_m.mean, r.accuracy_m.std, r.accuracy_m.rmse, r.accuracy_m.max,
        100 * r.completeness, r.distances_m.size(),
        a.align.empty() ? "no alignment" : "aligned by the trajectories (SE(3))");
    if (!a.json.empty())
        if (Status status = WriteTextFile(a.json, MeshErrorJson(r)); !status.ok()) return status;
    return a.picture.empty() ? Status::Ok() : PaintErrors(a.picture, mesh.value(), r);
}

CLI::App* AddEvaluation(CLI::App& eval, EvalArguments& a, const char* name, const char* text,
                        const char* estimate) {
    CLI::App* command = eval.add_subcommand(name, text);
    command->add_option("REFERENCE", a.reference, "Ground truth")->required();
    command->add_option(estimate, a.estimate, "Result to evaluate")->required();
    command->add_option("--json", a.json, "Write the figures to this file")->type_name("FILE");
    return command;
}

}  // namespace

void AddEvalCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<EvalArguments>();
    auto rpe_options = std::make_shared<RpeOptions>();
    CLI::App* eval = app.add_subcommand(
        "eval", "Evaluate a trajectory, a mesh, labels or detections against ground truth");
    eval->require_subcommand(1);

    CLI::App* ate =
        AddEvaluation(*eval, *a, "ate",
                      "Absolute trajectory error in metres, SE(3) alignment without scale, "
                      "pairs within 0.02 s (TUM trajectories)",
                      "ESTIMATE");
    ate->add_option("--plot", a->picture, "Plot both paths and the error over time")
        ->type_name("FILE.png");
    ate->callback([a, &context] { context.exit_code = ExitCode(EvalAte(*a)); });

    CLI::App* rpe = AddEvaluation(
        *eval, *a, "rpe",
        "Relative pose error (drift) over a fixed time interval (TUM trajectories)", "ESTIMATE");
    rpe->add_option("--delta", rpe_options->delta_s, "Time interval in seconds")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    rpe->callback(
        [a, rpe_options, &context] { context.exit_code = ExitCode(EvalRpe(*a, *rpe_options)); });

    auto tracked = std::make_shared<std::string>();
    CLI::App* drift = AddEvaluation(
        *eval, *a, "drift",
        "Relative pose error by the distance travelled, and what is left where the camera returns "
        "(TUM trajectories)",
        "ESTIMATE");
    drift->add_option("--plot", a->picture, "Plot the path before and after its correction")
        ->type_name("FILE.png");
    drift
        ->add_option("--tracked", *tracked,
                     "The path before its correction (default: trajectory_tracked.txt beside "
                     "ESTIMATE)")
        ->type_name("FILE");
    drift->callback(
        [a, tracked, &context] { context.exit_code = ExitCode(EvalDrift(*a, *tracked)); });

    CLI::App* mesh = AddEvaluation(*eval, *a, "mesh",
                                   "Surface error in metres, from the mesh's vertices to the "
                                   "reference's triangles (PLY)",
                                   "MESH");
    mesh->add_option(
            "--align", a->align,
            "Transform the mesh by the SE(3) that aligns the run's trajectory with the reference's")
        ->type_name("REFERENCE_TRAJECTORY RUN_TRAJECTORY")
        ->expected(2);
    mesh->add_option("--picture", a->picture, "Colour the mesh by its errors")
        ->type_name("FILE.png");
    mesh->callback([a, &context] { context.exit_code = ExitCode(EvalMesh(*a)); });

    AddObjectEvaluations(*eval, context);
}

}  // namespace tessera
