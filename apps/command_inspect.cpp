// tessera inspect: compares one measured frame with the view predicted from the map.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "config_options.h"
#include "io/image_io.h"
#include "run/inspect.h"

namespace tessera {
namespace {

struct InspectArguments {
    std::string source, out, tracker, labels = "none";
    std::int64_t frame = 0;
    ConfigOptions config;
};

Status Inspect(const InspectArguments& a) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return status;
    if (!a.tracker.empty())
        if (Status status = parameters.Set("tracking.method", a.tracker); !status.ok())
            return status;
    const Result<Inspection> result =
        InspectFrame(a.source, config, a.labels == "none" ? "" : a.labels, a.frame);
    if (!result.ok()) return result.status();
    const FrameReport& report = result.value().report;
    const TrackResult& t = report.track;
    if (!report.warning.empty()) fmt::print(stderr, "tessera: {}\n", Printable(report.warning));
    fmt::print(
        "frame {} by {}: {}{}{}; depth {:.1f} mm, intensity {:.3f} (robust rms); {:.0f} % in the "
        "map, {:.0f} % of it inliers\n",
        report.index, ToString(report.method), ToString(t.status), t.reason.empty() ? "" : ": ",
        t.reason, 1000 * t.distance_rms_m, t.intensity_rms, 100 * t.known_fraction,
        100 * t.inlier_fraction);
    return WriteColourImage(a.out, result.value().picture);
}

}  // namespace

void AddInspectCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<InspectArguments>();
    CLI::App* command = app.add_subcommand("inspect",
                                           "Compare one frame with the map in a picture: measured "
                                           "and predicted colour and depth, and residuals; or "
                                           "detections and objects");
    command->add_option("SOURCE", a->source, "As for tessera run")->required();
    command
        ->add_option("--frame", a->frame,
                     "Frame index as in frames.csv; the map is built from the frames before it")
        ->required()
        ->check(CLI::PositiveNumber);
    command->add_option("--out", a->out, "Picture to write, .png or .jpg")
        ->required()
        ->type_name("PICTURE.png");
    command
        ->add_option("--tracker", a->tracker, "Tracking method, as tracking.method (default sdf)")
        ->check(CLI::IsMember(TrackingMethodNames()));
    command
        ->add_option("--labels", a->labels,
                     "As for tessera run; shows the frame's detections and the map's objects "
                     "instead of residuals")
        ->type_name("MODEL|DETECTIONS|none")
        ->capture_default_str();
    a->config.AddTo(*command);
    command->callback([a, &context] { context.exit_code = ExitCode(Inspect(*a)); });
}

}  // namespace tessera
