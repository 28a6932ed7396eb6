#include "recordings/mkv_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "recordings/k4a_calibration.h"

namespace tessera {
namespace {

Result<K4aCalibration> ReadMkvCalibration(const InputFile& file, const MkvIndex& index) {
    const auto attachment =
        std::ranges::find(index.attachments, "calibration.json", &MkvAttachment::name);
    if (attachment == index.attachments.end())
        return Status::Error("the recording has no calibration.json");
    std::string text(static_cast<std::size_t>(attachment->bytes), '\0');
    Status read = file.ReadAt(attachment->offset,
                              {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
    if (!read.ok()) return read;
    while (text.ends_with('\0')) text.pop_back();
    Result<K4aCalibration> calibration = ParseK4aCalibration(text);
    if (calibration.ok()) return calibration;
    return Status::Error("its calibration.json is damaged: " + calibration.message());
}

bool AreUsableK4aCameras(const K4aCameras& cameras) {
    return std::isfinite(cameras.depth_error_px) && std::isfinite(cameras.colour_error_px) &&
           CheckPlausible(cameras.depth.pinhole).ok() &&
           CheckPlausible(cameras.colour.pinhole).ok();
}

void WarnOfMkvLenses(const K4aCameras& cameras, RecordingInfo& info) {
    constexpr double kMostError_px = 0.5;  // of the depth image
    const PinholeCamera& depth = cameras.depth.pinhole;
    if (cameras.depth_error_px > kMostError_px)
        info.warnings.push_back(
            fmt::format("the depth camera's lens is only approximated: depth is up to {:.1f} "
                        "pixels beside its place, most in the corners",
                        cameras.depth_error_px));
    if (cameras.colour_error_px * depth.fx / cameras.colour.pinhole.fx > kMostError_px)
        info.warnings.push_back(
            fmt::format("the colour camera's lens is only approximated: colour is up to {:.1f} of "
                        "its pixels beside its place, most in the corners",
                        cameras.colour_error_px));
    if (depth.width == depth.height)
        info.notes.push_back(fmt::format(
            "a wide depth mode: the middle {:.0f} degrees of its field of view are used",
            2 * std::atan(0.5 * depth.width / depth.fx) * 180 / std::numbers::pi));
}

}  // namespace

Status SetMkvCameras(const InputFile& file, const MkvIndex& index, ImageSize depth,
                     ImageSize colour, RecordingInfo& info) {
    const Result<K4aCalibration> own = ReadMkvCalibration(file, index);
    Result<K4aCameras> cameras =
        MakeK4aCameras(own.ok() ? own.value() : UsualK4aCalibration(), depth, colour);
    if (!cameras.ok()) return cameras.status();
    info.camera_known = own.ok() && AreUsableK4aCameras(cameras.value());
    if (!info.camera_known) {
        info.camera_from = "the calibration of a usual Azure Kinect";
        info.notes.push_back((own.ok() ? "its calibration.json is not plausible" : own.message()) +
                             "; " + info.camera_from + " is assumed");
        cameras = MakeK4aCameras(UsualK4aCalibration(), depth, colour);
    }
    info.depth_camera = cameras.value().depth;
    info.colour_camera = cameras.value().colour;
    info.depth_camera.fps = info.colour_camera.fps = info.fps;
    info.T_colour_depth = cameras.value().T_colour_depth;
    WarnOfMkvLenses(cameras.value(), info);
    return {};
}

}  // namespace tessera
