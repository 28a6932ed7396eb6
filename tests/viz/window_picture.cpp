// Makes docs/images/window.png: the window on a scan, half-way. Needs a display; under Xvfb:
//   build/release/apps/tessera synth room --out /tmp/room
//   xvfb-run -a -s "-screen 0 1280x720x24" build/release/tests/viz/window_picture docs/images/window.png /tmp/room 360
// Usage: window_picture PICTURE.png [SOURCE] [FRAMES] [all|follow]
#include <cstdio>
#include <cstdlib>
#include <string>

#include "io/image_io.h"
#include "system/open_source.h"
#include "viz/stepped_system.h"
#include "viz/viewer.h"

namespace tessera {
namespace {

int MakePicture(const std::string& path, const std::string& source_name, int frames, bool follow) {
    ViewerLink link;
    auto source = OpenSource(source_name, RunConfig{});
    if (!source.ok()) {
        std::fprintf(stderr, "%s\n", source.message().c_str());
        return 1;
    }
    PipelineConfig config;
    testing_support::SteppedSystem system(link, std::move(source.value()), config);
    ViewerOptions options;
    options.title = source_name;
    options.camera = system.camera();
    options.truncation_m = config.map.truncation_m;
    options.follow = follow;
    options.wait_s = 0;
    auto viewer = Viewer::Open(link, options);
    if (!viewer.ok()) {
        std::fprintf(stderr, "%s\n", viewer.message().c_str());
        return 1;
    }
    while (system.frames() < frames && system.Step()) {
        // The mesh comes over in pieces.
        do viewer.value()->RunOnce();
        while (!link.meshes.empty());
    }
    for (int i = 0; i < 50; ++i) viewer.value()->RunOnce();
    const Status status = WriteColourImage(path, viewer.value()->Picture());
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
    return status.ok() ? 0 : 1;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    return tessera::MakePicture(argv[1], argc > 2 ? argv[2] : "synthetic:room", argc > 3 ? std::atoi(argv[3]) : 200,
                                argc > 4 && argv[4] == std::string("follow"));
}
