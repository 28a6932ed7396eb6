#include "run/run_source.h"

#include "run/open_source.h"

namespace tessera {

RunConfig SourceSettings(const RunRecord& run) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    for (const auto& [key, value] : run.configuration)
        if (key.starts_with("source.") || key.starts_with("synthetic."))
            static_cast<void>(parameters.Set(key, value));
    if (run.camera) UseCamera(*run.camera, config);
    config.source.vignetting = run.vignetting;
    config.source.colour_delay_s = run.colour_delay_s;
    config.source.colour_shift_px = {run.colour_shift_px[0], run.colour_shift_px[1]};
    config.source.depth_distortion = run.depth_distortion;
    return config;
}

Result<std::unique_ptr<FrameSource>> OpenSourceOf(const RunRecord& run,
                                                  const std::string& moved_to) {
    const RunConfig config = SourceSettings(run);
    if (!moved_to.empty()) return OpenSource(moved_to, config);
    if (run.source_name.empty())
        return Status::Error("run.json does not name the run's source; repeat the run");
    if (IsLiveSource(run.source_name))
        return Status::Error("the run's frames came from a camera (" + run.source_name +
                             ") and are gone");
    return OpenSource(run.source_name, config);
}

}  // namespace tessera
