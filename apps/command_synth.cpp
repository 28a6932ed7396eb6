// tessera synth: writes a synthetic sequence with exact ground truth, as a folder that any RGB-D
// system can read.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "config_options.h"
#include "console.h"
#include "stop_signal.h"
#include "synth/sequence_writer.h"
#include "system/run_config.h"

namespace tessera {
namespace {

struct SynthArguments {
    std::string scene, out, trajectory, noise;
    int frames = 0, seed = -1;
    ConfigOptions config;
};

Status Configure(const SynthArguments& a, RunConfig& config) {
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return status;
    if (!a.trajectory.empty()) config.synthetic.trajectory = a.trajectory;
    if (a.frames > 0) config.synthetic.frames = a.frames;
    if (a.seed >= 0) config.synthetic.seed = a.seed;
    return a.noise.empty() ? Status::Ok() : parameters.Set("synthetic.sensor.noise", a.noise);
}

Status Synth(const SynthArguments& a) {
    RunConfig config;
    if (Status status = Configure(a, config); !status.ok()) return status;
    Result<std::unique_ptr<SyntheticSource>> source = OpenSynthetic(a.scene, config.synthetic);
    if (!source.ok()) return source.status();
    const std::atomic<bool>& stop = StopOnSignal();
    Console console;
    const Result<SequenceSummary> written =
        WriteSequence(*source.value(), a.out, [&](std::int64_t done, std::int64_t total) {
            RunCounts counts;
            counts.frames = done;
            console.ShowProgress(counts, total);
            return !stop;
        });
    if (!written.ok()) return written.status();
    const SequenceSummary& s = written.value();
    fmt::print("{}: {} frames over {:.2f} m, reference mesh of {} triangles\n", a.out, s.frames,
               s.path_m, s.reference_triangles);
    return Status::Ok();
}

}  // namespace

void AddSynthCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<SynthArguments>();
    CLI::App* command = app.add_subcommand(
        "synth", "Write a synthetic sequence with exact poses, labels and surface");
    std::string names;
    for (const std::string& name : BuiltinSceneNames()) names += (names.empty() ? "" : ", ") + name;
    command->add_option("SCENE", a->scene, "Built-in scene (" + names + ") or MODEL.obj")
        ->required();
    command->add_option("--out", a->out, "Output folder")->required()->type_name("DIR");
    command
        ->add_option("--trajectory", a->trajectory,
                     "Move along this TUM trajectory (default: the scene's own)")
        ->type_name("FILE");
    command->add_option("--frames", a->frames, "Number of frames (default: until the motion ends)")
        ->check(CLI::PositiveNumber);
    command->add_option("--noise", a->noise, "Sensor model (default none)")
        ->check(CLI::IsMember({"none", "kinect"}));
    command->add_option("--seed", a->seed, "Random seed of the noise (default 1)")
        ->check(CLI::NonNegativeNumber);
    a->config.AddTo(*command);
    command->callback([a, &context] { context.exit_code = ExitCode(Synth(*a)); });
}

}  // namespace tessera
