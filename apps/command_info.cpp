// tessera info: describes a source before a long run on it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "command.h"
#include "config_options.h"
#include "core/printable.h"
#include "run/open_source.h"
#include "run/other_files.h"
#include "run/scan_export.h"

namespace tessera {
namespace {

struct InfoArguments {
    std::string source;
    ConfigOptions config;
};

void PrintSource(const SourceInfo& info) {
    const PinholeCamera& c = info.camera;
    fmt::print("{}: {}\n", Printable(info.name), Printable(info.kind));
    if (info.frame_count >= 0)
        fmt::print("frames: {} pair{} of colour and depth, {:.3g} per second\n", info.frame_count,
                   info.frame_count == 1 ? "" : "s", info.fps);
    fmt::print("camera: {} x {}, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} px{}\n", c.width, c.height,
               c.fx, c.fy, c.cx, c.cy, info.lens_corrected ? ", lens distortion corrected" : "");
    fmt::print("ground truth: {}\n", info.has_truth ? "yes" : "no");
    for (const std::string& note : info.notes) fmt::print("note: {}\n", Printable(note));
    for (const std::string& warning : info.warnings)
        fmt::print("warning: {}\n", Printable(warning));
}

// The depth range of the first readable frame shows whether depth_scale is right.
void PrintFirstFrame(FrameSource& source) {
    Frame frame;
    ReadResult read;
    constexpr int kMostWaits = 20;  // each up to half a second, for a camera that delivers nothing
    int waits = 0;
    do {
        read = source.Read(frame);
        if (!read.message.empty()) fmt::print("note: {}\n", Printable(read.message));
        waits += read.status == ReadStatus::kWait;
    } while (read.status == ReadStatus::kSkip ||
             (read.status == ReadStatus::kWait && waits < kMostWaits));
    if (read.status != ReadStatus::kOk) return;
    std::vector<float> depths;
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i)
        if (frame.depth_m.data()[i] > 0) depths.push_back(frame.depth_m.data()[i]);
    fmt::print("first frame: stamp {:.6f} s, {}, ", frame.stamp_s,
               frame.colour.empty() ? "no colour" : "colour");
    if (depths.empty()) {
        fmt::print("no depth\n");
        return;
    }
    std::sort(depths.begin(), depths.end());
    fmt::print(
        "depth in {:.0f} % of the pixels, {:.2f} to {:.2f} m, median {:.2f} m\n",
        100.0 * static_cast<double>(depths.size()) / static_cast<double>(frame.depth_m.size()),
        depths.front(), depths.back(), depths[depths.size() / 2]);
}

int Info(const InfoArguments& a) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return Fail(status);
    if (a.source.ends_with(".scan")) {
        const Result<std::string> text = DescribeScan(a.source);
        if (!text.ok()) return Fail(text.status());
        fmt::print("{}", text.value());
        return kExitDone;
    }
    if (const std::string other = DescribeOtherFile(a.source); !other.empty()) {
        fmt::print("{}: {}\n", Printable(a.source), Printable(other));
        return kExitDone;
    }
    Result<std::unique_ptr<FrameSource>> source = OpenSource(a.source, config);
    if (!source.ok()) return Fail(source.status());
    PrintSource(source.value()->info());
    PrintFirstFrame(*source.value());
    fmt::print("to scan it: tessera run {} --out DIR\n", Printable(ShellLine({a.source})));
    return kExitDone;
}

}  // namespace

void AddInfoCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<InfoArguments>();
    CLI::App* command = app.add_subcommand("info", "Say what a source, a file or a folder is");
    command->add_option("SOURCE", a->source, "A source, as for run, or any other file or folder")
        ->required();
    a->config.AddTo(*command);
    command->callback([a, &context] { context.exit_code = Info(*a); });
}

}  // namespace tessera
