#include <chrono>
#include <cmath>
#include <cstring>

#include "kinect/kinect.h"

namespace tessera::kinect {
namespace {

constexpr int kWidth = 640, kHeight = 480, kRate_hz = 30;
// Nominal focal lengths in pixels. Registered depth has the colour camera's.
constexpr double kColourFocal_px = 525, kDepthFocal_px = 575.8;

template <class T>
OniStatus Answer(T value, void* data, int* size) {
    if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, &value, sizeof(T));
    *size = sizeof(T);
    return ONI_STATUS_OK;
}

float FieldOfView_rad(int pixels, double focal_px) {
    return static_cast<float>(2 * std::atan(0.5 * pixels / focal_px));
}

// The unit of the camera's own stamps is not documented, so images are stamped when they arrive.
std::uint64_t Now_us() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

OniVideoMode KinectStream::Mode(bool depth) {
    return {depth ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888, kWidth, kHeight,
            kRate_hz};
}

OniStatus KinectStream::setProperty(int id, const void* data, int size) {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) {
        const OniVideoMode only = Mode(depth_);
        return size == static_cast<int>(sizeof(only)) && std::memcmp(data, &only, sizeof(only)) == 0
                   ? ONI_STATUS_OK
                   : ONI_STATUS_NOT_SUPPORTED;
    }
    OniBool on = FALSE;
    if (size != static_cast<int>(sizeof(on)) || !isPropertySupported(id))
        return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&on, data, sizeof(on));
    freenect_flag flag = depth_ ? FREENECT_MIRROR_DEPTH : FREENECT_MIRROR_VIDEO;
    switch (id) {
        case ONI_STREAM_PROPERTY_MIRRORING: break;
        case ONI_STREAM_PROPERTY_AUTO_EXPOSURE: flag = FREENECT_AUTO_EXPOSURE; break;
        case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE: flag = FREENECT_AUTO_WHITE_BALANCE; break;
        default: return ONI_STATUS_NOT_SUPPORTED;
    }
    {
        const std::lock_guard lock(mutex_);
        switches_[id] = on;
    }
    freenect_device* const device = kinect_.device();
    kinect_.usb().Later(device, [device, flag, on] {
        freenect_set_flag(device, flag, on ? FREENECT_ON : FREENECT_OFF);
    });
    return ONI_STATUS_OK;
}

OniStatus KinectStream::getProperty(int id, void* data, int* size) {
    const double focal_px = depth_ && !kinect_.registered() ? kDepthFocal_px : kColourFocal_px;
    switch (id) {
        case ONI_STREAM_PROPERTY_VIDEO_MODE: return Answer(Mode(depth_), data, size);
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return Answer(FieldOfView_rad(kWidth, focal_px), data, size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return Answer(FieldOfView_rad(kHeight, focal_px), data, size);
        // Without this property the player of .oni files returns no frame of a recording.
        case ONI_STREAM_PROPERTY_CROPPING:
            return Answer(OniCropping{FALSE, 0, 0, kWidth, kHeight}, data, size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return depth_ ? Answer(FREENECT_DEPTH_MM_MAX_VALUE, data, size)
                          : ONI_STATUS_NOT_SUPPORTED;
        default: break;
    }
    const std::lock_guard lock(mutex_);
    const auto found = switches_.find(id);
    const bool has = found != switches_.end() && (!depth_ || id == ONI_STREAM_PROPERTY_MIRRORING);
    return has ? Answer(found->second, data, size) : ONI_STATUS_NOT_SUPPORTED;
}

OniBool KinectStream::isPropertySupported(int id) {
    char value[64];
    int size = sizeof(value);
    return getProperty(id, value, &size) == ONI_STATUS_OK ? TRUE : FALSE;
}

OniStatus KinectStream::start() {
    return kinect_.usb().Locked([this] {
        freenect_device* const device = kinect_.device();
        const bool failed =
            depth_ ? freenect_set_depth_mode(
                         device,
                         freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM,
                                                  kinect_.registered() ? FREENECT_DEPTH_REGISTERED
                                                                       : FREENECT_DEPTH_MM)) < 0 ||
                         freenect_start_depth(device) < 0
                   : freenect_set_video_mode(device,
                                             freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM,
                                                                      FREENECT_VIDEO_RGB)) < 0 ||
                         freenect_start_video(device) < 0;
        running_ = !failed;
        return failed ? ONI_STATUS_ERROR : ONI_STATUS_OK;
    });
}

void KinectStream::stop() {
    kinect_.usb().Locked([this] {
        if (!running_) return;
        running_ = false;
        depth_ ? freenect_stop_depth(kinect_.device()) : freenect_stop_video(kinect_.device());
    });
}

void KinectStream::Give(const void* pixels) {
    if (!running_) return;
    OniFrame* const image = getServices().acquireFrame();
    if (image == nullptr) return;
    const int pixel_bytes = depth_ ? 2 : 3;
    image->sensorType = depth_ ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR;
    image->timestamp = Now_us();
    image->frameIndex = ++number_;
    image->videoMode = Mode(depth_);
    image->width = kWidth;
    image->height = kHeight;
    image->croppingEnabled = FALSE;
    image->cropOriginX = image->cropOriginY = 0;
    image->stride = kWidth * pixel_bytes;
    image->dataSize = kHeight * image->stride;
    std::memcpy(image->data, pixels, static_cast<std::size_t>(image->dataSize));
    raiseNewFrame(image);
    getServices().releaseFrame(image);
}

}  // namespace tessera::kinect
