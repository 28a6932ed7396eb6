// tessera sweep alpha: measures the influence of the photometric weight on each sequence, as [B14]
// figure 6 tabulates it.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "config_options.h"
#include "console.h"
#include "io/file.h"
#include "run/run.h"
#include "stop_signal.h"

namespace tessera {
namespace {

struct SweepArguments {
    std::vector<std::string> sources;
    std::string values = "0:1:0.1", out;
    std::int64_t frames = -1, stride = 1;
    ConfigOptions config;
};

struct Row {
    std::string source;
    double alpha, ate_rmse_m, tracked_fraction, fps;
};

// "FIRST:LAST:STEP", including both ends.
Result<std::vector<double>> ParseValues(const std::string& text) {
    double first = 0, last = 0, step = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf:%lf:%lf%c", &first, &last, &step, &rest) != 3)
        return Status::Error(
            fmt::format("--values {}: expected FIRST:LAST:STEP, such as 0:1:0.1", text));
    const double count = std::floor((last - first) / step + 1e-9) + 1;
    if (!(first >= 0 && last >= first && step > 0 && last <= 100 && count <= 1000))
        return Status::Error(fmt::format(
            "--values {}: needs 0 <= FIRST <= LAST <= 100 and at most 1000 steps", text));
    std::vector<double> values;
    for (int i = 0; i < static_cast<int>(count); ++i) values.push_back(first + i * step);
    return values;
}

Result<Row> RunOne(const SweepArguments& a, const std::string& source, double alpha,
                   const std::atomic<bool>& stop) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return status;
    config.pipeline.trackers.photometric.alpha_mode = ResidualModel::AlphaMode::kFixed;
    config.pipeline.trackers.photometric.alpha = alpha;
    RunRequest request;
    request.source = source;
    request.selection.count = a.frames;
    request.selection.stride = a.stride;
    Console console;
    RunObserver observer;
    observer.on_frame = [&](const RunCounts& counts, std::int64_t total) {
        console.ShowProgress(counts, total);
    };
    const Result<RunSummary> run = ExecuteRun(request, config, observer, stop);
    if (!run.ok()) return run.status();
    const RunSummary& s = run.value();
    if (!s.source.has_truth)
        return Status::Error(source + ": has no ground truth to evaluate against");
    const double nan = std::nan("");
    return Row{source, alpha, s.ate ? s.ate->error_m.rmse : nan,
               static_cast<double>(s.counts.tracked) / static_cast<double>(s.counts.frames), s.fps};
}

Status WriteRows(const std::string& folder, const std::vector<Row>& rows) {
    std::string csv = "source,alpha,ate_rmse_m,tracked_fraction,fps\n";
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Row& row : rows) {
        csv += fmt::format("\"{}\",{:.6g},{:.6f},{:.4f},{:.1f}\n", row.source, row.alpha,
                           row.ate_rmse_m, row.tracked_fraction, row.fps);
        json.push_back({{"source", row.source},
                        {"alpha", row.alpha},
                        {"ate_rmse_m", row.ate_rmse_m},
                        {"tracked_fraction", row.tracked_fraction},
                        {"fps", row.fps}});
    }
    if (Status status = WriteTextFile(folder + "/sweep.csv", csv); !status.ok()) return status;
    return WriteTextFile(
        folder + "/sweep.json",
        json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

Status Sweep(const SweepArguments& a) {
    const Result<std::vector<double>> values = ParseValues(a.values);
    if (!values.ok()) return values.status();
    if (!a.out.empty())
        if (Status status = PrepareOutputFolder(a.out); !status.ok()) return status;
    const std::atomic<bool>& stop = StopOnSignal();
    std::vector<Row> rows;
    fmt::print("ATE RMSE in metres, SE(3) alignment without scale over all frames\n");
    for (const std::string& source : a.sources)
        for (const double alpha : values.value()) {
            const Result<Row> row = RunOne(a, source, alpha, stop);
            if (!row.ok()) return row.status();
            if (stop) return Status::Ok();  // discard a run that was cut short
            rows.push_back(row.value());
            fmt::print("{}  alpha {:.3g}  {:.4f}  tracked {:.1f} %\n", source, alpha,
                       rows.back().ate_rmse_m, 100 * rows.back().tracked_fraction);
            std::fflush(stdout);
            if (a.out.empty()) continue;
            if (Status status = WriteRows(a.out, rows); !status.ok()) return status;
        }
    return Status::Ok();
}

}  // namespace

void AddSweepCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<SweepArguments>();
    CLI::App* sweep =
        app.add_subcommand("sweep", "Run sources repeatedly with different values of a setting");
    sweep->require_subcommand(1);
    CLI::App* alpha = sweep->add_subcommand(
        "alpha", "Vary the photometric weight, tracking.photometric.alpha, in m^2");
    alpha->add_option("SOURCE", a->sources, "Folders or synthetic:NAME, with ground truth")
        ->required();
    alpha->add_option("--values", a->values, "Values to try, including both ends")
        ->type_name("FIRST:LAST:STEP")
        ->capture_default_str();
    alpha->add_option("--out", a->out, "Folder for sweep.csv and sweep.json")->type_name("DIR");
    alpha->add_option("--frames", a->frames, "Number of frames per source (default: all)")
        ->check(CLI::PositiveNumber);
    alpha->add_option("--stride", a->stride, "Use every Nth frame")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    a->config.AddTo(*alpha);
    alpha->callback([a, &context] { context.exit_code = ExitCode(Sweep(*a)); });
}

}  // namespace tessera
