// Makes docs/images/window.png: the window in the middle of a scan. Needs a display. With Xvfb:
//   xvfb-run -a -s "-screen 0 1280x720x24" build/release/tests/viz/window_picture
//   docs/images/window.png synthetic:desk 200
// Usage: window_picture PICTURE.png SOURCE FRAMES [LABELS|none [colour|label|weight [follow]]]
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
    std::string picture, source, labels, shading;
    std::int64_t frames = 0;
    bool follow = false;
};

ViewerOptions OptionsOf(const Arguments& a, const RunConfig& config, const SourceInfo& source) {
    ViewerOptions options;
    options.title = a.source;
    options.camera = source.camera;
    options.truncation_m = config.pipeline.map.truncation_m;
    options.labelled = !a.labels.empty();
    options.shading = a.shading == "label"    ? Shading::kLabel
                      : a.shading == "weight" ? Shading::kWeight
                                              : Shading::kColour;
    options.follow = a.follow;
    options.wait_s = 0;
    return options;
}

int Fail(const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    return 1;
}

int MakePicture(const Arguments& a) {
    const RunConfig config;
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
    if (argc < 4) return 2;
    const auto optional = [&](int i) { return std::string(argc > i ? argv[i] : ""); };
    const std::string labels = optional(4);
    return tessera::MakePicture({argv[1], argv[2], labels == "none" ? "" : labels, optional(5),
                                 std::atoll(argv[3]), optional(6) == "follow"});
}
