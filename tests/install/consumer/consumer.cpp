// Scans the built-in desk and prints how much of it was tracked.
#include <cstdio>

#include "run/run.h"

int main() {
    tessera::RunConfig config;
    config.synthetic.camera = {160, 120, 131, 131, 79.5, 59.5};
    config.pipeline.map.voxel_size_m = 0.04;
    config.pipeline.map.truncation_m = 0.16;
    tessera::RunRequest request;
    request.source = "synthetic:desk";
    request.selection.count = 5;
    const auto run = tessera::ExecuteRun(request, config, {}, std::atomic<bool>(false));
    if (!run.ok())
        std::fprintf(stderr, "%s\n", run.message().c_str());
    else
        std::printf("%d of %d tracked\n", static_cast<int>(run.value().counts.tracked),
                    static_cast<int>(run.value().counts.frames));
    return run.ok() ? 0 : 1;
}
