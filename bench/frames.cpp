// Measures how many frames per second are tracked and fused if they are already in memory: no
// decoding, no files, no mesh. Prints the rate and the median of each stage for each run. Also
// prints what must be equal for all runs and devices: the number of tracked frames, and a hash of
// their poses. Usage: frames SOURCE [--frames N] [--runs N] [--device cpu|cuda] [--config
// NAME|FILE] [--set KEY=VALUE]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <vector>

#include "../apps/config_options.h"
#include "core/stopwatch.h"
#include "cuda/open_device.h"
#include "io/frame_reader.h"
#include "run/open_source.h"
#include "run/timings.h"
#include "system/pipeline.h"

namespace tessera {
namespace {

struct Options {
    std::string source, device = "cpu";
    std::int64_t frames = 300;
    int runs = 3;
    ConfigOptions config;
};

struct Recording {
    PinholeCamera camera;
    std::vector<Frame> frames;
};

Result<Recording> ReadAll(const Options& options, const RunConfig& config) {
    Result<std::unique_ptr<FrameSource>> source = OpenSource(options.source, config);
    if (!source.ok()) return source.status();
    FrameReader reader(std::move(source.value()), {.count = options.frames}, config.read_ahead);
    Recording recording{reader.info().camera, {}};
    while (true) {
        Frame frame;
        const ReadResult read = reader.Next(frame);
        if (read.status == ReadStatus::kError) return Status::Error(read.message);
        if (read.status == ReadStatus::kEnd) return recording;
        if (read.status == ReadStatus::kOk) recording.frames.push_back(std::move(frame));
    }
}

// FNV-1a.
std::uint64_t Hash(std::uint64_t hash, const Eigen::Matrix4d& pose) {
    unsigned char bytes[sizeof(double) * 16];
    std::memcpy(bytes, pose.data(), sizeof bytes);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    return hash;
}

void RunOnce(const Recording& recording, const RunConfig& config, Backend* device) {
    Pipeline pipeline(config.pipeline, recording.camera, config.meshing, device);
    StageTimes times;
    std::uint64_t hash = 0xcbf29ce484222325u;
    int tracked = 0;
    const Stopwatch whole;
    for (const Frame& frame : recording.frames) {
        const Stopwatch watch;
        const FrameReport report = pipeline.Process(frame);
        times.Add("frame", watch.ElapsedMs());
        times.Add("prepare", report.prepare_ms);
        times.Add("track", report.track_ms);
        times.Add("allocate", report.fusion.allocate_ms);
        times.Add("fuse", report.fusion.fuse_ms);
        tracked += report.tracked();
        hash = Hash(hash, report.track.T_world_camera.matrix());
    }
    const double seconds = whole.ElapsedMs() / 1000;
    fmt::print("{:7.1f} frames/s;", static_cast<double>(recording.frames.size()) / seconds);
    for (const auto& [stage, statistics] : times.Summarise())
        fmt::print(" {} {:.3f}", stage, statistics.median_ms);
    fmt::print(" ms; {} of {} tracked, {} blocks, poses {:016x}\n", tracked,
               recording.frames.size(), pipeline.mapping().blocks().size() - 1, hash);
}

Status Run(const Options& options) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = options.config.Apply(parameters); !status.ok()) return status;
    if (Status status = config.Validate(); !status.ok()) return status;
    std::unique_ptr<Backend> device;
    if (options.device == "cuda") {
        Result<std::unique_ptr<Backend>> opened = OpenGpu(config.pipeline.device_memory_mb);
        if (!opened.ok()) return opened.status();
        device = std::move(opened.value());
    }
    const Result<Recording> recording = ReadAll(options, config);
    if (!recording.ok()) return recording.status();
    fmt::print("{}, {}\n", options.source, device ? device->name() : "processor");
    for (int run = 0; run < options.runs; ++run) RunOnce(recording.value(), config, device.get());
    return Status::Ok();
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    CLI::App app("Tracks and fuses frames that are in memory already");
    tessera::Options options;
    app.add_option("SOURCE", options.source, "As tessera run")->required();
    app.add_option("--frames", options.frames, "Number of frames to keep in memory")
        ->check(CLI::PositiveNumber);
    app.add_option("--runs", options.runs, "Runs, each from an empty map")
        ->check(CLI::PositiveNumber);
    app.add_option("--device", options.device, "Where")->check(CLI::IsMember({"cpu", "cuda"}));
    options.config.AddTo(app);
    CLI11_PARSE(app, argc, argv);
    const tessera::Status status = tessera::Run(options);
    if (!status.ok()) fmt::print(stderr, "{}\n", status.message());
    return status.ok() ? 0 : 2;
}
