#include "run_in_window.h"

#include <chrono>
#include <future>
#include <thread>

#include "models_beside.h"
#include "viz/measuring.h"
#include "viz/viewer.h"

namespace tessera {
namespace {

ViewerOptions OptionsFor(const RunRequest& request, const RunConfig& config,
                         const SourceInfo& source) {
    ViewerOptions options;
    options.title = source.name;
    options.screen.width = config.view.width;
    options.screen.height = config.view.height;
    options.close_at_end = config.view.close_at_end;
    options.output_folder = request.output_folder.empty() ? "." : request.output_folder;
    options.measurements = MeasurementsFile(options.output_folder);
    options.camera = source.camera;
    options.truncation_m = config.pipeline.map.truncation_m;
    const TrackersConfig& trackers = config.pipeline.trackers;
    options.labelled = !request.labels.empty();
    options.detector = request.labels;
    options.models = ModelsBeside(request.labels);
    options.max_weight = config.pipeline.fusion.max_weight;
    if (source.live) options.view_kind = ViewKind::kScan;
    options.settings.method = trackers.method;
    options.settings.auto_alpha =
        trackers.photometric.alpha_mode == ResidualModel::AlphaMode::kAuto;
    options.settings.alpha = trackers.photometric.alpha;
    options.settings.max_depth_m = config.pipeline.frame.max_depth_m;
    options.settings.prealign = config.pipeline.prealign.enabled;
    if (config.loops.enabled && request.poses_file.empty()) options.settings.loops = true;
    options.settings.prediction = trackers.icp.prediction;
    options.settings.labels.prediction = config.labels.prediction;
    return options;
}

// Keeps the window alive until the run has opened its source, or was refused. Closing it stops the
// run.
void WaitInWindow(const std::future<std::optional<SourceInfo>>& opening,
                  const std::function<bool()>& while_opening, ViewerLink& link) {
    bool stopped = false;
    while (opening.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        if (stopped)
            static_cast<void>(opening.wait_for(std::chrono::milliseconds(50)));
        else if (!while_opening())
            stopped = true, link.commands.Push({ViewerCommand::Kind::kStop, {}});
    }
}

}  // namespace

Result<RunSummary> ExecuteRunInWindow(RunRequest request, const RunConfig& config, Console& console,
                                      const std::atomic<bool>& stop, const GivenWindow& given) {
    ViewerLink link;
    link.open.store(true);
    request.viewer = &link;
    std::promise<std::optional<SourceInfo>> opened;
    std::atomic<bool> is_open{false};
    RunObserver observer = console.Observer();
    observer.on_open = [&, on_open = observer.on_open](const SourceInfo& source) {
        on_open(source);
        if (!is_open.exchange(true)) opened.set_value(source);
    };
    std::optional<Result<RunSummary>> result;
    std::jthread run([&] {
        result = ExecuteRun(request, config, observer, stop);
        link.ended.store(true);
        if (!is_open.exchange(true)) opened.set_value(std::nullopt);
    });
    std::future<std::optional<SourceInfo>> opening = opened.get_future();
    if (given.while_opening) WaitInWindow(opening, given.while_opening, link);
    if (const std::optional<SourceInfo> source = opening.get()) {
        ViewerOptions options = OptionsFor(request, config, *source);
        options.window = given.window;
        Result<std::unique_ptr<Viewer>> viewer = Viewer::Open(link, options);
        if (viewer.ok())
            while (viewer.value()->RunOnce() && !(link.ended.load() && stop.load())) {
            }
        else
            console.Warning("no window: " + viewer.message() + "; continuing without one");
    }
    link.open.store(false);
    run.join();
    return std::move(*result);
}

}  // namespace tessera
