// A live run of many minutes with a restless user: at random it resets, switches the tracker, saves
// meshes and scans, records, pauses, and turns fusion and loops off and on. Prints, for each part
// of the run, the memory and how long frames waited for their pose. scripts/soak starts it with a
// camera that is unplugged now and then.
// Usage: soak [SOURCE] [--minutes M] [--seed N] [--labels MODEL] [--out DIR] [--config NAME|FILE]
// [--set KEY=VALUE]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <thread>

#include "restless_user.h"
#include "run/run.h"

namespace tessera {
namespace {

using soak::Options;
using soak::RestlessUser;

Result<bool> Run(const Options& options) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = options.config.Apply(parameters); !status.ok()) return status;
    if (Status status = config.Validate(); !status.ok()) return status;
    std::filesystem::remove_all(options.out);
    ViewerLink link;
    RunRequest request;
    request.source = options.source;
    request.live = true;
    request.viewer = &link;
    request.labels = options.labels;
    request.output_folder = options.out;
    request.scan_file = options.out + "/soak.scan";
    std::filesystem::create_directories(options.out);
    std::map<std::string, int> warnings;
    RunObserver observer;
    observer.on_warning = [&](const std::string& text) {
        // Numbers differ from one to the next.
        std::string kind;
        for (const char c : text)
            if (c < '0' || c > '9') kind += c;
        if (++warnings[kind] <= 3) fmt::print(stderr, "warning: {}\n", text);
    };
    RestlessUser user(options, config, link);
    std::jthread thread([&] { user.Use(); });
    const std::atomic<bool> stop{false};
    const Result<RunSummary> summary = ExecuteRun(request, config, observer, stop);
    link.ended = true;
    thread.join();
    if (!summary.ok()) return summary.status();
    const RunCounts& n = summary.value().counts;
    fmt::print("since the last reset: {} frames, {} tracked, {} fused, {} dropped, {} not fused\n",
               n.frames, n.tracked, n.fused, n.dropped, n.unfused);
    return user.Report();
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    CLI::App app("A live run with a restless user");
    tessera::Options options;
    app.add_option("SOURCE", options.source, "As tessera run");
    app.add_option("--minutes", options.minutes, "How long")->check(CLI::PositiveNumber);
    app.add_option("--reset", options.reset_s, "Seconds from one reset to the next");
    app.add_option("--seed", options.seed, "Of the user");
    app.add_option("--labels", options.labels, "As tessera run");
    app.add_option("--out", options.out, "Folder, which is emptied first");
    options.config.AddTo(app);
    CLI11_PARSE(app, argc, argv);
    const tessera::Result<bool> kept = tessera::Run(options);
    if (!kept.ok()) fmt::print(stderr, "{}\n", kept.message());
    return !kept.ok() ? 2 : kept.value() ? 0 : 1;
}
