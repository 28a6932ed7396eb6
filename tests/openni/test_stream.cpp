#include <algorithm>
#include <cmath>
#include <cstring>

#include "openni/test_device.h"

namespace tessera::test_device {
namespace {

template <class T>
OniStatus Answer(T value, void* data, int* size) {
    if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, &value, sizeof(T));
    *size = sizeof(T);
    return ONI_STATUS_OK;
}

// Copies every factor-th pixel.
template <int kChannels, class T>
void Copy(const std::vector<T>& from, int from_width, const OniVideoMode& mode, int factor,
          void* to) {
    auto* out = static_cast<T*>(to);
    for (int y = 0; y < mode.resolutionY; ++y)
        for (int x = 0; x < mode.resolutionX; ++x)
            for (int c = 0; c < kChannels; ++c)
                *out++ =
                    from[static_cast<std::size_t>((y * from_width + x) * factor * kChannels + c)];
}

}  // namespace

TestStream::TestStream(TestDevice& device, bool depth)
    : device_(device), depth_(depth), mode_(device.Mode(depth, device.shared().settings.small)) {}

OniStatus TestStream::setProperty(int id, const void* data, int size) {
    const std::lock_guard lock(mutex_);
    const auto log = [&](const char* name, int value) {
        device_.shared().log(std::string(depth_ ? "depth " : "colour ") + name + " " +
                             std::to_string(value));
    };
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof(OniVideoMode))) {
        OniVideoMode mode;
        std::memcpy(&mode, data, sizeof(mode));
        const auto is_offered = [&](bool small) {
            const OniVideoMode offered = device_.Mode(depth_, small);
            return std::memcmp(&mode, &offered, sizeof(mode)) == 0;
        };
        if (!is_offered(true) && (device_.shared().settings.small || !is_offered(false)))
            return ONI_STATUS_NOT_SUPPORTED;
        mode_ = mode;
        return ONI_STATUS_OK;
    }
    if (size != static_cast<int>(sizeof(OniBool))) return ONI_STATUS_NOT_SUPPORTED;
    OniBool value = FALSE;
    std::memcpy(&value, data, sizeof(value));
    switch (id) {
        case ONI_STREAM_PROPERTY_MIRRORING:
            mirror_ = value;
            log("mirror", value);
            return ONI_STATUS_OK;
        case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
            auto_exposure_ = value;
            log("auto_exposure", value);
            return ONI_STATUS_OK;
        case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
            auto_white_balance_ = value;
            log("auto_white_balance", value);
            return ONI_STATUS_OK;
        default: return ONI_STATUS_NOT_SUPPORTED;
    }
}

OniStatus TestStream::getProperty(int id, void* data, int* size) {
    const std::lock_guard lock(mutex_);
    const DeviceFeed& feed = *device_.shared().feed;
    switch (id) {
        case ONI_STREAM_PROPERTY_VIDEO_MODE: return Answer(mode_, data, size);
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return Answer(static_cast<float>(2 * std::atan(0.5 * feed.width() / feed.fx())), data,
                          size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return Answer(static_cast<float>(2 * std::atan(0.5 * feed.height() / feed.fy())), data,
                          size);
        // Without this property the player of .oni files returns no frame of a recording.
        case ONI_STREAM_PROPERTY_CROPPING:
            return Answer(OniCropping{FALSE, 0, 0, mode_.resolutionX, mode_.resolutionY}, data,
                          size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return depth_ ? Answer(10000, data, size) : ONI_STATUS_NOT_SUPPORTED;
        case ONI_STREAM_PROPERTY_MIRRORING: return Answer(mirror_, data, size);
        case ONI_STREAM_PROPERTY_AUTO_EXPOSURE: return Answer(auto_exposure_, data, size);
        case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE: return Answer(auto_white_balance_, data, size);
        default: return ONI_STATUS_NOT_SUPPORTED;
    }
}

OniBool TestStream::isPropertySupported(int id) {
    char value[64];
    int size = sizeof(value);
    return getProperty(id, value, &size) == ONI_STATUS_OK ? TRUE : FALSE;
}

OniStatus TestStream::start() {
    {
        const std::lock_guard lock(giving_);
        running_ = true;
    }
    device_.Started();
    return ONI_STATUS_OK;
}

void TestStream::stop() {
    const std::lock_guard lock(giving_);
    running_ = false;
}

void TestStream::Give(const FeedFrame& frame, int number, std::uint64_t stamp_us, Fault fault) {
    const std::lock_guard lock(giving_);
    if (!running_ || fault == Fault::kDropped) return;
    OniFrame* const image = getServices().acquireFrame();
    if (image == nullptr) return;
    OniVideoMode mode;
    {
        const std::lock_guard property_lock(mutex_);
        mode = mode_;
    }
    image->timestamp = stamp_us;
    Fill(frame, mode, number, fault, *image);
    raiseNewFrame(image);
    getServices().releaseFrame(image);
}

void TestStream::Fill(const FeedFrame& frame, const OniVideoMode& mode, int number, Fault fault,
                      OniFrame& image) const {
    const DeviceFeed& feed = *device_.shared().feed;
    const int factor = std::max(1, feed.width() / mode.resolutionX);
    if (depth_)
        Copy<1>(frame.depth_mm, feed.width(), mode, factor, image.data);
    else
        Copy<3>(frame.rgb, feed.width(), mode, factor, image.data);
    const int pixel_bytes = depth_ ? 2 : 3;
    image.dataSize = mode.resolutionX * mode.resolutionY * pixel_bytes;
    image.sensorType = depth_ ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR;
    image.frameIndex = number + 1;
    image.width = mode.resolutionX;
    image.height = mode.resolutionY;
    image.videoMode = mode;
    image.croppingEnabled = FALSE;
    image.cropOriginX = image.cropOriginY = 0;
    image.stride = mode.resolutionX * pixel_bytes;
    if (fault == Fault::kWrongSize) {
        image.width /= 2;
        image.height /= 2;
        image.stride /= 2;
        image.dataSize /= 4;
    }
    if (fault == Fault::kNoData) image.dataSize = image.width = image.height = 0;
    if (fault == Fault::kNoise)
        for (int i = 0; i < image.dataSize; ++i)
            static_cast<std::uint8_t*>(image.data)[i] = static_cast<std::uint8_t>(
                Mixed(static_cast<std::uint64_t>(number), static_cast<std::uint64_t>(i)));
    if (fault == Fault::kBackwards) image.timestamp -= 500000;
    if (fault == Fault::kAbsurdStamp) image.timestamp = std::uint64_t{1} << 62;
}

}  // namespace tessera::test_device
