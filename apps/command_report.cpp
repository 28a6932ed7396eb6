// tessera report: writes one HTML file that shows a finished run.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "report/report_html.h"
#include "system/run_config.h"

namespace tessera {
namespace {

struct ReportArguments {
    std::string run, out = "report.html", truth;
    std::size_t triangles = ReportOptions().most_triangles;
};

// Every setting with its default.
std::vector<KnownSetting> KnownSettings() {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    std::vector<KnownSetting> known;
    for (const ConfigParameters::Parameter& p : parameters.parameters())
        known.push_back({p.key, p.unit, p.default_value});
    return known;
}

Status Report(const ReportArguments& a) {
    ReportOptions options;
    options.truth = a.truth;
    options.settings = KnownSettings();
    options.version = TESSERA_VERSION;
    options.most_triangles = a.triangles;
    const Result<WrittenReport> report = WriteReport(a.run, a.out, options);
    if (!report.ok()) return report.status();
    for (const std::string& damage : report.value().damaged)
        fmt::print(stderr, "tessera: note: {}\n", Printable(damage));
    for (const std::string& line : report.value().left_out) fmt::print("{}\n", Printable(line));
    fmt::print("{}  {:.1f} MB; open it in a browser\n", a.out,
               static_cast<double>(report.value().bytes) / 1e6);
    return Status::Ok();
}

}  // namespace

void AddReportCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<ReportArguments>();
    CLI::App* command = app.add_subcommand(
        "report",
        "Write one HTML file that shows a run: model, path, errors, times, objects, settings");
    command->add_option("RUN_DIR", a->run, "Folder that tessera run --out wrote")->required();
    command->add_option("--out", a->out, "The page; loads nothing, so it can be sent and kept")
        ->type_name("FILE.html")
        ->capture_default_str();
    command
        ->add_option("--truth", a->truth,
                     "True path (TUM trajectory) for the errors (default: groundtruth.txt in "
                     "RUN_DIR, else that of the run's source)")
        ->type_name("FILE");
    command
        ->add_option("--triangles", a->triangles,
                     "Show at most this many; a larger model is made coarser")
        ->check(CLI::Range(std::size_t{1000}, std::size_t{20'000'000}))
        ->capture_default_str();
    command->callback([a, &context] { context.exit_code = ExitCode(Report(*a)); });
}

}  // namespace tessera
