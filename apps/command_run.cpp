// tessera run: turns a source into a trajectory, a mesh and their statistics.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "console.h"
#include "cuda/open_device.h"
#include "run/open_source.h"
#include "run/run.h"
#include "run_in_window.h"
#include "run_options.h"
#include "run_text.h"
#include "stop_signal.h"

namespace tessera {
namespace {

// The exit code.
Result<int> Run(const RunArguments& a, const CommandContext& context) {
    RunConfig config;
    if (Status status = Configure(a, config); !status.ok()) return status;
    std::unique_ptr<Backend> device;
    if (a.device == "cuda") {  // auto means the CPU until the CUDA backend has run on a GPU
        Result<std::unique_ptr<Backend>> opened = OpenGpu(config.pipeline.device_memory_mb);
        if (!opened.ok()) return opened.status();
        device = std::move(opened.value());
    }
    RunRequest request = a.request;
    request.device = device.get();
    const bool by_default = a.mode == "auto";
    request.live = by_default ? IsLiveSource(request.source) : a.mode == "live";
    if (by_default && request.live)
        std::fputs("info: live, as for every camera; --mode lockstep drops no frame\n", stderr);
    request.resume = !a.resume.empty();
    request.localise_only = !a.localise_only.empty();
    request.scan_file = a.existing().empty() ? a.scan : a.existing();
    if (a.labels != "none") request.labels = a.labels;
    for (const std::string& text : a.switches) {
        const Result<MethodSwitch> change = ParseSwitch(text);
        if (!change.ok()) return change.status();
        request.switches.push_back(change.value());
    }
    Result<RunSummary> result = [&] {
        Console console;
        if (a.view)
            return ExecuteRunInWindow(request, config, console, StopOnSignal(),
                                      {context.window, context.while_opening});
        return ExecuteRun(request, config, console.Observer(), StopOnSignal());
    }();
    if (!result.ok()) return result.status();
    const RunSummary& summary = result.value();
    std::fputs(RunText(request, summary).c_str(), stdout);
    const std::int64_t looked_at = summary.counts.frames - summary.counts.dropped;
    if (2 * summary.counts.tracked >= looked_at) return kExitDone;
    std::fputs(fmt::format("tessera: only {} of {} frames tracked; last reason: {}\n",
                           summary.counts.tracked, looked_at, Printable(summary.last_reason))
                   .c_str(),
               stderr);
    return kExitMostlyLost;
}

}  // namespace

void AddRunCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<RunArguments>();
    a->request.output_folder = "out";
    CLI::App* command = app.add_subcommand(
        "run", "Track and fuse a source; write trajectory, mesh, picture and timings");
    AddRunOptions(*command, *a);
    command->callback([a, &context] {
        a->request.command_line = context.arguments;
        const Result<int> code = Run(*a, context);
        context.Finish(code.status(), code.ok() ? code.value() : kExitBadInput);
    });
}

}  // namespace tessera
