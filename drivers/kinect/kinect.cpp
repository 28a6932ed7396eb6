#include "kinect/kinect.h"

#include <cstring>

namespace tessera::kinect {

std::unique_ptr<Kinect> Kinect::Open(UsbThread& usb, const std::string& serial) {
    std::unique_ptr<Kinect> kinect(new Kinect(usb, serial));
    const bool opened = usb.Locked([&] {
        if (freenect_open_device_by_camera_serial(usb.context(), &kinect->device_, serial.c_str()) <
            0) {
            kinect->device_ = nullptr;
            return false;
        }
        freenect_set_user(kinect->device_, kinect.get());
        freenect_set_depth_callback(
            kinect->device_, [](freenect_device* device, void* pixels, std::uint32_t) {
                KinectStream* const depth = static_cast<Kinect*>(freenect_get_user(device))->depth_;
                if (depth != nullptr) depth->Give(pixels);
            });
        freenect_set_video_callback(kinect->device_, [](freenect_device* device, void* pixels,
                                                        std::uint32_t) {
            KinectStream* const colour = static_cast<Kinect*>(freenect_get_user(device))->colour_;
            if (colour != nullptr) colour->Give(pixels);
        });
        return true;
    });
    return opened ? std::move(kinect) : nullptr;
}

Kinect::~Kinect() {
    if (device_ != nullptr) usb_.Locked([this] { usb_.Close(device_); });
}

OniStatus Kinect::getSensorInfoList(OniSensorInfo** sensors, int* count) {
    *sensors = sensors_;
    *count = 2;
    return ONI_STATUS_OK;
}

oni::driver::StreamBase* Kinect::createStream(OniSensorType type) {
    if (type != ONI_SENSOR_DEPTH && type != ONI_SENSOR_COLOR) return nullptr;
    const bool is_depth = type == ONI_SENSOR_DEPTH;
    auto stream = std::make_unique<KinectStream>(*this, is_depth);
    return usb_.Locked([&] { return (is_depth ? depth_ : colour_) = stream.release(); });
}

void Kinect::destroyStream(oni::driver::StreamBase* stream) {
    usb_.Locked([&] {
        if (stream == depth_) depth_ = nullptr;
        if (stream == colour_) colour_ = nullptr;
    });
    delete stream;
}

OniStatus Kinect::setProperty(int id, const void* data, int size) {
    OniImageRegistrationMode mode = ONI_IMAGE_REGISTRATION_OFF;
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != static_cast<int>(sizeof(mode)))
        return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&mode, data, sizeof(mode));
    registered_ = mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    return ONI_STATUS_OK;
}

OniStatus Kinect::getProperty(int id, void* data, int* size) {
    const OniImageRegistrationMode mode =
        registered_ ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR : ONI_IMAGE_REGISTRATION_OFF;
    const bool is_serial = id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER;
    if (!is_serial && id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
    const void* const value = is_serial ? static_cast<const void*>(serial_.c_str()) : &mode;
    const auto bytes = static_cast<int>(is_serial ? serial_.size() + 1 : sizeof(mode));
    if (*size < bytes) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, value, static_cast<std::size_t>(bytes));
    *size = bytes;
    return ONI_STATUS_OK;
}

OniBool Kinect::isPropertySupported(int id) {
    return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER;
}

}  // namespace tessera::kinect
