#include "io/openni_setup.h"

#include <OpenNI.h>

#include <algorithm>
#include <cmath>

#include "io/camera_store.h"
#include "io/openni_modes.h"

namespace tessera {
namespace {

using openni::VideoMode;
using openni::VideoStream;

StreamMode Described(const VideoMode& mode) {
    StreamMode result{mode.getResolutionX(), mode.getResolutionY(), mode.getFps(), true, 0};
    switch (mode.getPixelFormat()) {
        case openni::PIXEL_FORMAT_DEPTH_1_MM:
        case openni::PIXEL_FORMAT_RGB888: break;
        case openni::PIXEL_FORMAT_DEPTH_100_UM:
        case openni::PIXEL_FORMAT_GRAY8: result.preference = 1; break;
        default: result.usable = false;
    }
    return result;
}

std::vector<StreamMode> ModesOf(const VideoStream& stream) {
    const openni::Array<VideoMode>& modes = stream.getSensorInfo().getSupportedVideoModes();
    std::vector<StreamMode> described;
    for (int i = 0; i < modes.getSize(); ++i) described.push_back(Described(modes[i]));
    return described;
}

Status ChooseAndSetModes(const OpenniStreams& s) {
    const auto chosen = ChooseModes(ModesOf(s.depth), ModesOf(s.colour));
    if (!chosen)
        return Status::Error(
            "depth and colour have no image size in common (with 16-bit depth, RGB or grey "
            "colour)");
    const auto set = [](VideoStream& stream, std::size_t index) {
        return stream.setVideoMode(
            stream.getSensorInfo().getSupportedVideoModes()[static_cast<int>(index)]);
    };
    if (set(s.depth, chosen->first) != openni::STATUS_OK ||
        set(s.colour, chosen->second) != openni::STATUS_OK)
        return Status::Error("cannot set the image size and frame rate: " + OpenniErrorText());
    return Status::Ok();
}

void SetRegistration(openni::Device& device, OpenniCamera::About& about) {
    const auto wanted = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    if (!device.isImageRegistrationModeSupported(wanted) ||
        device.setImageRegistrationMode(wanted) != openni::STATUS_OK)
        about.notes.push_back(
            "the device does not register depth to colour: depth is used as it is, and colours are "
            "offset from their surface by the distance between the two lenses");
}

// Focal length of a pinhole camera with this field of view.
double Focal_px(int pixels, float fov_rad) {
    return pixels / (2 * std::tan(static_cast<double>(fov_rad) / 2));
}

// Registered depth has the colour camera's view.
PinholeCamera CameraOf(const OpenniStreams& s, const OpenniConfig& config,
                       OpenniCamera::About& about) {
    const VideoMode mode = s.depth.getVideoMode();
    const bool registered =
        s.device.getImageRegistrationMode() == openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    const VideoStream& stream = registered ? s.colour : s.depth;
    const int width = mode.getResolutionX(), height = mode.getResolutionY();
    PinholeCamera camera{width,
                         height,
                         Focal_px(width, stream.getHorizontalFieldOfView()),
                         Focal_px(height, stream.getVerticalFieldOfView()),
                         (width - 1) / 2.0,
                         (height - 1) / 2.0};
    const auto plausible = [](double focal, int pixels) {
        return focal > 0.2 * pixels && focal < 10.0 * pixels;
    };
    if (!plausible(camera.fx, width) || !plausible(camera.fy, height)) {
        camera.fx = camera.fy = 525.0 / 640 * width;  // close to a Kinect's
        if (config.fx == 0 || config.fy == 0) {
            about.camera_known = false;
            about.camera_from = "a Kinect's focal length";
            about.notes.push_back("the device reports no usable field of view; using " +
                                  about.camera_from + " (set source.openni.fx and fy)");
        }
    }
    return camera;
}

Status CheckModes(const OpenniStreams& s, OpenniCamera::About& about) {
    const StreamMode depth = Described(s.depth.getVideoMode()),
                     colour = Described(s.colour.getVideoMode());
    if (!depth.usable || !colour.usable)
        return Status::Error("unsupported pixel format: depth must be 16-bit, colour RGB or grey");
    if (depth.width != colour.width || depth.height != colour.height)
        return Status::Error(
            fmt::format("depth has {} x {} pixels, colour {} x {}; the sizes must match",
                        depth.width, depth.height, colour.width, colour.height));
    if (depth.width < 16 || depth.height < 16 || depth.width > 8192 || depth.height > 8192)
        return Status::Error(
            fmt::format("{} x {} pixels is not a plausible size", depth.width, depth.height));
    const int fps = std::clamp(depth.fps, 1, 1000);
    about.fps = fps;
    about.shortest_period_s = 1.0 / std::max(fps, std::clamp(colour.fps, 1, 1000));
    about.depth_units_per_m = depth.preference == 0 ? 1000 : 10000;
    if (depth.width != 640 || depth.height != 480 || depth.fps != 30 || colour.fps != 30)
        about.notes.push_back(fmt::format(
            "{} x {} pixels, depth at {} and colour at {} frames per second (requested: 640 x 480 "
            "at 30)",
            depth.width, depth.height, depth.fps, colour.fps));
    return Status::Ok();
}

// The device's own values or those of a camera file, and what the configuration says.
Status FindCalibrationOf(const OpenniConfig& config, OpenniCamera::About& about) {
    about.calibration.pinhole = about.camera;
    about.calibration.depth_scale = about.depth_units_per_m;
    const auto stored =
        FindCalibration(config.calibration, about.serial, about.camera.width, about.camera.height);
    if (!stored.ok()) return stored.status();
    if (stored.value()) {
        about.calibration = stored.value()->calibration;
        about.camera_known = true;
        about.camera_from = stored.value()->path;
        if (!about.calibration.depth_scale_given)
            about.calibration.depth_scale = about.depth_units_per_m;
        about.notes.push_back("calibration from " + stored.value()->path);
    }
    PinholeCamera& camera = about.calibration.pinhole;
    for (const auto& [wanted, value] : {std::pair{config.fx, &camera.fx},
                                        {config.fy, &camera.fy},
                                        {config.cx, &camera.cx},
                                        {config.cy, &camera.cy}})
        if (wanted > 0) *value = wanted;
    if (config.fx > 0 && config.fy > 0) about.camera_from = "source.openni.fx";
    return {};
}

}  // namespace

Status SetUpOpenniStreams(const OpenniStreams& s, bool is_recording, const OpenniConfig& config,
                          OpenniCamera::About& about) {
    for (const auto& [stream, sensor, name] : {std::tuple{&s.depth, openni::SENSOR_DEPTH, "depth"},
                                               {&s.colour, openni::SENSOR_COLOR, "colour"}}) {
        if (s.device.getSensorInfo(sensor) == nullptr)
            return Status::Error(fmt::format("has no {} images", name));
        if (stream->create(s.device, sensor) != openni::STATUS_OK)
            return Status::Error(
                fmt::format("its {} stream cannot be opened: {}", name, OpenniErrorText()));
    }
    if (!is_recording) {
        if (Status status = ChooseAndSetModes(s); !status.ok()) return status;
        if (config.registration) SetRegistration(s.device, about);
        for (VideoStream* stream : {&s.depth, &s.colour}) (void)stream->setMirroringEnabled(false);
    }
    for (const VideoStream* stream : {&s.depth, &s.colour})
        if (stream->getMirroringEnabled())
            return Status::Error(
                "its images are mirrored, which cannot be undone; record it again without "
                "mirroring");
    if (Status status = CheckModes(s, about); !status.ok()) return status;
    about.camera = CameraOf(s, config, about);
    return FindCalibrationOf(config, about);
}

Status StartOpenniStreams(const OpenniStreams& s, bool is_recording, const OpenniConfig& config,
                          OpenniCamera::About& about) {
    for (VideoStream* stream : {&s.depth, &s.colour})
        if (stream->start() != openni::STATUS_OK)
            return Status::Error("its streams cannot be started: " + OpenniErrorText());
    if (is_recording) return Status::Ok();
    if (openni::CameraSettings* settings = s.colour.getCameraSettings()) {
        (void)settings->setAutoExposureEnabled(config.auto_exposure);
        (void)settings->setAutoWhiteBalanceEnabled(config.auto_white_balance);
    }
    about.frame_sync =
        config.frame_sync && s.device.setDepthColorSyncEnabled(true) == openni::STATUS_OK;
    if (!about.frame_sync) s.device.setDepthColorSyncEnabled(false);
    return Status::Ok();
}

}  // namespace tessera
