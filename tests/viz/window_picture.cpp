// Makes docs/images/window.png and scan_view.png: the window in the middle of a run. Needs a
// display. With Xvfb:
//   xvfb-run -a -s "-screen 0 1280x720x24" build/release/tests/viz/window_picture
//   docs/images/window.png synthetic:desk 40 labels=synthetic coverage follow
// Usage: window_picture PICTURE.png SOURCE FRAMES [labels=MODEL] [colour|label|weight|coverage]
//        [follow] [scan] [scale=S] [size=WxH] [tracker=METHOD]
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "io/image_io.h"
#include "run/open_source.h"
#include "run/run.h"
#include "system/viewer_link.h"
#include "viz/viewer.h"

namespace tessera {
namespace {

struct Arguments {
    std::string picture, source, labels, tracker;
    std::int64_t frames = 0;
    Shading shading = Shading::kColour;
    ViewKind view_kind = ViewKind::kExpert;
    bool follow = false;
    double scale = 0;
    int width = 1280, height = 720;
};

Arguments Parse(int argc, char** argv) {
    Arguments a;
    a.picture = argv[1], a.source = argv[2], a.frames = std::atoll(argv[3]);
    for (int i = 4; i < argc; ++i) {
        const std::string word = argv[i], value = word.substr(word.find('=') + 1);
        if (word.starts_with("labels=")) a.labels = value;
        if (word.starts_with("tracker=")) a.tracker = value;
        if (word.starts_with("scale=")) a.scale = std::atof(value.c_str());
        if (word.starts_with("size=")) std::sscanf(value.c_str(), "%dx%d", &a.width, &a.height);
        if (word == "label") a.shading = Shading::kLabel;
        if (word == "weight") a.shading = Shading::kWeight;
        if (word == "coverage") a.shading = Shading::kCoverage;
        if (word == "scan") a.view_kind = ViewKind::kScan;
        if (word == "follow") a.follow = true;
    }
    return a;
}

ViewerOptions OptionsOf(const Arguments& a, const RunConfig& config, const SourceInfo& source) {
    ViewerOptions options;
    options.title = a.source;
    options.screen.width = a.width;
    options.screen.height = a.height;
    options.screen.scale = a.scale;
    options.camera = source.camera;
    options.truncation_m = config.pipeline.map.truncation_m;
    options.labelled = !a.labels.empty();
    options.detector = a.labels;
    options.settings.loops = true;
    options.shading = a.shading;
    options.view_kind = a.view_kind;
    options.follow = a.follow;
    options.screen.wait_s = 0;
    return options;
}

int Fail(const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    return 1;
}

int MakePicture(const Arguments& a) {
    RunConfig config;
    if (!a.tracker.empty())
        config.pipeline.trackers.method =
            TrackingMethodOf(a.tracker).value_or(TrackingMethod::kSdf);
    const auto source = OpenSource(a.source, config);
    if (!source.ok()) return Fail(source.message());
    ViewerLink link;
    auto viewer = Viewer::Open(link, OptionsOf(a, config, source.value()->info()));
    if (!viewer.ok()) return Fail(viewer.message());

    RunRequest request;
    request.source = a.source;
    request.labels = a.labels;
    request.viewer = &link;
    std::atomic<bool> reached{false}, taken{false}, stop{false};
    RunObserver observer;
    observer.on_frame = [&](const RunCounts& counts, std::int64_t) {
        if (counts.frames < a.frames) return;
        reached = true;
        taken.wait(false);  // the run pauses for the screenshot
        stop = true;
    };
    std::optional<Result<RunSummary>> run;
    std::jthread thread([&] {
        run = ExecuteRun(request, config, observer, stop);
        reached = true;
    });
    while (!reached || !link.meshes.empty()) viewer.value()->RunOnce();
    for (int i = 0; i < 50; ++i) viewer.value()->RunOnce();
    const Status status = WriteColourImage(a.picture, viewer.value()->Picture());
    taken = true;
    taken.notify_all();
    thread.join();
    if (!run->ok()) return Fail(run->message());
    return status.ok() ? 0 : Fail(status.message());
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return argc < 4 ? 2 : tessera::MakePicture(tessera::Parse(argc, argv));
}
