// tessera doctor: reports what this build can do on this machine and why something is off.
#include <tbb/info.h>
#include <tbb/version.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <opencv2/core/version.hpp>

#include "command.h"
#include "core/cpu.h"
#include "cuda/open_device.h"
#include "export/vdb_writer.h"
#include "finish/decimate.h"
#include "io/openni_devices.h"
#include "optimize/pose_graph.h"
#include "recordings/open_recording.h"
#include "render/gl_context.h"
#include "scan/database.h"
#include "semantics/dnn_detector.h"
#include "system/run_config.h"

namespace tessera {
namespace {

void PrintCameras(const OpenniListing& listing) {
    const std::string library = listing.built_in ? "OpenNI2 " + listing.version + ": " : "";
    const std::string count =
        listing.devices.empty() ? "none" : std::to_string(listing.devices.size());
    fmt::print("cameras      {}{}\n", library, listing.built_in ? count : listing.advice.front());
    if (!listing.built_in) return;
    for (const OpenniDevice& device : listing.devices)
        fmt::print("             openni2:{}  {} {}\n", device.uri, device.vendor, device.name);
    for (const std::string& line : listing.advice) fmt::print("             {}\n", line);
}

const char* Window() {
#ifndef TESSERA_HAVE_WINDOW
    return "off: built without a window; install libimgui-dev, libglfw3-dev and libepoxy-dev and "
           "build again";
#else
    return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY") ? "on"
                                                                    : "no display: set DISPLAY";
#endif
}

void PrintExports() {
    const char* volumes = VdbAvailable() ? ", volumes .vdb" : "";
    fmt::print("exports      meshes .ply .obj .glb, point clouds, paths (TUM, KITTI), {}{}\n",
               "images for nerfstudio and COLMAP", volumes);
    if (!VdbAvailable()) fmt::print("             .vdb {}\n", kVdbUnavailable);
    fmt::print(
        "             maps for robots (.yaml .bt .npy), floor plans (.svg .dxf), finished models, "
        "reports (.html)\n");
    if (!DecimationAvailable())
        fmt::print("             decimation of finished models {}\n", kDecimationUnavailable);
}

int Doctor() {
    const double memory_gb = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                             static_cast<double>(sysconf(_SC_PAGE_SIZE)) /
                             (1024.0 * 1024.0 * 1024.0);
    fmt::print("tessera {}, built with g++ {}, OpenCV {}, oneTBB {}\n", TESSERA_VERSION,
               __VERSION__, CV_VERSION, TBB_VERSION_STRING);
    fmt::print("CPU          {} threads, SIMD: {}\n", tbb::info::default_concurrency(),
               CpuHasAvx2() ? "AVX2" : "baseline (no AVX2 on this machine: about half the speed)");
    fmt::print("memory       {:.1f} GB\n", memory_gb);
    std::string presets;
    for (const Preset& preset : Presets()) presets += " " + preset.name;
    fmt::print("presets     {}\n", presets);
    fmt::print(
        "sources      folders (TUM RGB-D, ICL-NUIM, 7-Scenes, camera.yaml), .oni recordings, .klg "
        "logs, scan files, synthetic scenes\n");
    const auto gl = GlContext::Create();
    fmt::print("OpenGL       {}\n", gl.ok() ? gl.value()->renderer() : "off: " + gl.message());
    PrintCameras(ListOpenniDevices());
    fmt::print("window       {}\n", Window());
    fmt::print("loop closure {}\n",
               PoseGraphAvailable() ? "on" : "off: install libceres-dev and build again");
    fmt::print("scan files   {}\n",
               ScanAvailable() ? "on" : std::string("off: ") + kScanUnavailable);
    PrintExports();
    fmt::print("recordings   {}\n", RecordingsAvailable()
                                        ? ".bag .mcap .db3 .mkv .r3d .sens, folders of phone apps"
                                        : std::string("off: ") + kRecordingsUnavailable);
    fmt::print("labels       {}\n", HasDnn()
                                        ? "networks (.onnx, Darknet), detections files"
                                        : "detections files; networks need OpenCV's dnn module");
    fmt::print("CUDA         {}\n", DescribeGpus());
    return kExitDone;
}

}  // namespace

void AddDoctorCommand(CLI::App& app, CommandContext& context) {
    CLI::App* command =
        app.add_subcommand("doctor", "Report what this build can do on this machine");
    command->callback([&context] { context.exit_code = Doctor(); });
}

}  // namespace tessera
