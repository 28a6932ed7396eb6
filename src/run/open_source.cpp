#include "run/open_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "io/corrected_depth.h"
#include "io/folder_layout.h"
#include "io/klg_source.h"
#include "io/openni_devices.h"
#include "io/openni_source.h"
#include "io/pipe_source.h"
#include "recordings/open_recording.h"
#include "run/other_files.h"
#include "run/wrong_folder.h"
#include "scan/scan_source.h"

namespace tessera {
namespace {

// Why a name that is no file is no source either.
std::string NameProblem(const std::string& name) {
    const std::size_t colon = name.find(':');
    const std::string scheme = name.substr(0, colon);
    const bool word = colon != std::string::npos && colon > 1 &&
                      std::ranges::all_of(scheme, [](unsigned char c) { return std::isalnum(c); });
    if (!word) return "no such folder";
    for (const char* camera : {"realsense", "orbbec", "kinect", "k4a", "oak", "depthai", "v4l2"})
        if (scheme == camera)
            return scheme +
                   ": is not a kind of source; cameras without OpenNI2 send their frames to pipe:- "
                   "(docs/camera.md)";
    return scheme + ": is not a kind of source";
}

Result<std::unique_ptr<FrameSource>> OpenFolder(const std::string& name,
                                                const FolderSourceConfig& config) {
    if (const std::string above = AboveRecording(name); !above.empty())
        return Status::Error(name + ": " + above);
    Result<std::unique_ptr<FrameSource>> opened = OpenFolderSource(name, config);
    if (opened.ok() || opened.message().find(kUnknownLayout) == std::string::npos) return opened;
    const std::string wrong = DescribeWrongFolder(name);
    return wrong.empty() ? std::move(opened) : Status::Error(name + ": " + wrong);
}

Result<std::unique_ptr<FrameSource>> OpenAsItIs(const std::string& name, const RunConfig& config,
                                                const std::atomic<bool>* stop) {
    if (name.starts_with("synthetic:")) return OpenSyntheticScene(name, config.synthetic);
    if (name.starts_with(kOpenniPrefix) || name.ends_with(".oni"))
        return OpenOpenniSource(name, config.openni);
    if (name.starts_with(kPipePrefix))
        return OpenPipeSource(name, config.source, kLongestWait_s, stop);
    if (name.ends_with(".scan")) return ScanSource::Open(name);
    if (name.ends_with(".klg")) return OpenKlgSource(name, config.source);
    constexpr const char* kSources =
        "a source is a folder, FILE.oni, .klg, .bag, .mcap, .db3, .mkv, .r3d, .sens or .scan, "
        "openni2:, pipe:- or synthetic:NAME";
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored))
        return Status::Error(fmt::format("{}: {} ({})", name, NameProblem(name), kSources));
    if (IsRecording(name)) return OpenRecording(name, config.source);
    if (const std::string other = DescribeOtherFile(name); !other.empty())
        return Status::Error(fmt::format("{}: is no source of frames: {}", name, other));
    if (!std::filesystem::is_directory(name, ignored))
        return Status::Error(fmt::format("{}: is a file; {}", name, kSources));
    return OpenFolder(name, config.source);
}

}  // namespace

bool IsLiveSource(const std::string& name) {
    return name.starts_with(kOpenniPrefix) || name.starts_with(kPipePrefix);
}

void UseCamera(const PinholeCamera& camera, RunConfig& config) {
    config.source.camera = camera;
    config.openni.fx = camera.fx;
    config.openni.fy = camera.fy;
    config.openni.cx = camera.cx;
    config.openni.cy = camera.cy;
}

Result<std::unique_ptr<FrameSource>> OpenSource(const std::string& name, const RunConfig& config,
                                                const std::atomic<bool>* stop) {
    Result<std::unique_ptr<FrameSource>> opened = OpenAsItIs(name, config, stop);
    if (!opened.ok()) return opened;
    return CorrectDepth(std::move(opened.value()), config.source.depth_distortion);
}

}  // namespace tessera
