#include "run_options.h"

#include <charconv>

#include "system/scan_plan.h"

namespace tessera {
namespace {

void AddSource(CLI::App& command, RunArguments& a) {
    command
        .add_option(
            "SOURCE", a.request.source,
            "Folder (TUM RGB-D, ICL-NUIM, 7-Scenes, or images with a camera.yaml), "
            "openni2: (a depth camera; openni2:URI for a specific one), FILE.oni, "
            "FILE.klg, FILE.scan (the frames stored in a scan), .bag, .mcap, .db3, .mkv, .r3d or "
            ".sens, the folder of a phone app (Stray Scanner, Polycam; docs/recordings.md), pipe:- "
            "or pipe:SOCKET "
            "(frames from another program), or synthetic:NAME (desk, room, flat, walk, "
            "corridor, floor, corner, wall, people, chair, door)")
        ->required();
    command.add_option("--out", a.request.output_folder, "Folder for the results")
        ->type_name("DIR")
        ->capture_default_str();
    a.config.AddTo(command);
}

void AddMethod(CLI::App& command, RunArguments& a) {
    command.add_option("--tracker", a.tracker, "Tracking method, as tracking.method (default sdf)")
        ->check(CLI::IsMember(TrackingMethodNames()));
    command
        .add_option(
            "--switch", a.switches,
            "Switch to another tracking method at this frame (index as in frames.csv); repeatable")
        ->type_name("FRAME:METHOD")
        ->allow_extra_args(false);
    command
        .add_option(
            "--alpha", a.alpha,
            "Weight of the photometric residual in m^2, or auto; sets tracking.photometric.alpha")
        ->type_name("A|auto");
}

void AddFrames(CLI::App& command, RunArguments& a) {
    command.add_option("--start", a.request.selection.start, "First frame, counted from 0")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command
        .add_option("--frames", a.request.selection.count,
                    "Number of frames to read (default: all)")
        ->check(CLI::PositiveNumber);
    command.add_option("--stride", a.request.selection.stride, "Use every Nth frame")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        .add_option("--threads", a.threads,
                    "Threads for parallel loops, 0 = one per core; sets run.threads")
        ->check(CLI::Range(0, 256));
    command
        .add_option(
            "--poses", a.request.poses_file,
            "Do not track; fuse at the poses of this TUM trajectory (stamps in seconds, metres; "
            "of the optical camera: x right, y down, z forward)")
        ->type_name("FILE");
    command
        .add_option("--mode", a.mode,
                    "lockstep: every frame, in order; live: the newest frame wins, at the pace of "
                    "the camera or recording; auto: live for a camera, else lockstep")
        ->check(CLI::IsMember({"auto", "lockstep", "live"}))
        ->capture_default_str();
}

void AddLabelsAndLoops(CLI::App& command, RunArguments& a) {
    command
        .add_option(
            "--labels", a.labels,
            "Label objects with this network (.onnx, or .cfg with .weights beside it), with a "
            "detections file, or with synthetic: the ground truth of a synthetic: source")
        ->type_name("MODEL|DETECTIONS|none")
        ->capture_default_str();
    command
        .add_option("--loop-closure", a.loop_closure,
                    "Close loops: correct path and map when the camera returns to a known place, "
                    "and relocalise after tracking is lost; sets loops.enabled (default on; off "
                    "with --poses)")
        ->check(CLI::IsMember({"on", "off"}));
    command.add_flag("--view", a.view,
                     "Open a window; without a display the run continues without one");
}

void AddFilesAndDevice(CLI::App& command, RunArguments& a) {
    command
        .add_option("--record", a.request.record_path,
                    "Record the raw frames to this new folder (TUM layout, exact depth), or to "
                    "FILE.oni with an OpenNI2 camera")
        ->type_name("PATH");
    CLI::Option* scan = command
                            .add_option("--scan", a.scan,
                                        "Save the scan continuously to this new file; a killed "
                                        "run loses at most the last second")
                            ->type_name("FILE");
    CLI::Option* resume =
        command
            .add_option("--resume", a.resume,
                        "Continue a saved scan, from any place that it has seen, and save to the "
                        "same file; voxel size and truncation are those of the scan; frames of "
                        "the same recording that are already in it are skipped")
            ->type_name("FILE")
            ->excludes(scan);
    command
        .add_option("--localise-only", a.localise_only,
                    "Track the camera in a saved scan, which is only read; nothing is fused")
        ->type_name("FILE")
        ->excludes(scan)
        ->excludes(resume);
    command
        .add_option("--device", a.device,
                    "Where to compute map and tracking: auto uses the CPU; cuda uses the first "
                    "NVIDIA GPU (experimental, not yet tested on one)")
        ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
        ->capture_default_str();
}

}  // namespace

void AddRunOptions(CLI::App& command, RunArguments& a) {
    for (const auto add : {AddSource, AddMethod, AddFrames, AddLabelsAndLoops, AddFilesAndDevice})
        add(command, a);
}

Result<MethodSwitch> ParseSwitch(const std::string& text) {
    const std::size_t colon = text.find(':');
    MethodSwitch change;
    const char* end = text.data() + std::min(colon, text.size());
    const auto [rest, error] = std::from_chars(text.data(), end, change.frame);
    const bool number =
        colon != std::string::npos && error == std::errc() && rest == end && change.frame >= 0;
    const auto method = number ? TrackingMethodOf(text.substr(colon + 1)) : std::nullopt;
    if (!method)
        return Status::Error(
            fmt::format("--switch {}: expected FRAME:METHOD, such as 100:icp; methods: {}", text,
                        fmt::join(TrackingMethodNames(), ", ")));
    change.method = *method;
    return change;
}

Status Configure(const RunArguments& a, RunConfig& config) {
    ConfigParameters parameters;
    config.Describe(parameters);
    if (!a.existing().empty())
        if (Status status = TakeScanKeys(a.existing(), parameters); !status.ok()) return status;
    if (Status status = a.config.Apply(parameters); !status.ok()) return status;
    if (!a.tracker.empty())
        if (Status status = parameters.Set("tracking.method", a.tracker); !status.ok())
            return status;
    if (!a.alpha.empty()) {
        const bool automatic = a.alpha == "auto";
        if (Status status =
                parameters.Set("tracking.photometric.alpha_mode", automatic ? "auto" : "fixed");
            !status.ok())
            return status;
        if (!automatic)
            if (Status status = parameters.Set("tracking.photometric.alpha", a.alpha); !status.ok())
                return Status::Error("--alpha: " + status.message());
    }
    if (a.loop_closure == "on" && !a.request.poses_file.empty())
        return Status::Error(
            "--loop-closure on: not possible with --poses, which already gives the poses; leave "
            "one of the two out");
    if (!a.loop_closure.empty())
        if (Status status =
                parameters.Set("loops.enabled", a.loop_closure == "on" ? "true" : "false");
            !status.ok())
            return status;
    if (a.threads >= 0)
        if (Status status = parameters.Set("run.threads", std::to_string(a.threads)); !status.ok())
            return status;
    return a.existing().empty() ? Status::Ok() : CheckScanKeys(a.existing(), parameters);
}

}  // namespace tessera
