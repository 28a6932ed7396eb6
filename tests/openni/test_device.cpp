#include "openni/test_device.h"

#include <cmath>
#include <cstring>
#include <string_view>

namespace tessera::test_device {

TestDevice::TestDevice(Shared& shared, std::function<void()> vanish)
    : shared_(shared), vanish_(std::move(vanish)) {
    for (const int depth : {0, 1}) {
        const bool small = shared_.settings.small;
        modes_[depth][0] = Mode(depth == 1, true);
        modes_[depth][1] = Mode(depth == 1, false);
        sensors_[depth] = {depth == 1 ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR, small ? 1 : 2,
                           modes_[depth]};
    }
}

TestDevice::~TestDevice() = default;

OniVideoMode TestDevice::Mode(bool depth, bool small) const {
    const int divisor = small ? 2 : 1;
    return {depth ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888,
            shared_.feed->width() / divisor, shared_.feed->height() / divisor,
            static_cast<int>(std::lround(shared_.settings.rate_hz))};
}

OniStatus TestDevice::getSensorInfoList(OniSensorInfo** sensors, int* count) {
    *sensors = sensors_;
    *count = 2;
    return ONI_STATUS_OK;
}

oni::driver::StreamBase* TestDevice::createStream(OniSensorType type) {
    const std::lock_guard lock(mutex_);
    if (type == ONI_SENSOR_DEPTH) return depth_ = new TestStream(*this, true);
    if (type == ONI_SENSOR_COLOR) return colour_ = new TestStream(*this, false);
    return nullptr;
}

void TestDevice::destroyStream(oni::driver::StreamBase* stream) {
    const std::lock_guard lock(mutex_);
    if (stream == depth_) depth_ = nullptr;
    if (stream == colour_) colour_ = nullptr;
    delete stream;
}

OniStatus TestDevice::setProperty(int id, const void* data, int size) {
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ||
        size != static_cast<int>(sizeof(registration_)))
        return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&registration_, data, sizeof(registration_));
    shared_.log("registration " + std::to_string(registration_));
    return ONI_STATUS_OK;
}

OniStatus TestDevice::getProperty(int id, void* data, int* size) {
    constexpr std::string_view kSerial = "TEST 0042";
    if (id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER && *size > static_cast<int>(kSerial.size())) {
        std::memcpy(data, kSerial.data(), kSerial.size());
        *size = static_cast<int>(kSerial.size());
        return ONI_STATUS_OK;
    }
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ||
        *size < static_cast<int>(sizeof(registration_)))
        return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(data, &registration_, sizeof(registration_));
    return ONI_STATUS_OK;
}

OniBool TestDevice::isImageRegistrationModeSupported(OniImageRegistrationMode mode) {
    return mode == ONI_IMAGE_REGISTRATION_OFF || shared_.settings.registration ? TRUE : FALSE;
}

void TestDevice::Started() {
    const std::lock_guard lock(mutex_);
    if (!shared_.settings.fast && !thread_.joinable())
        thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
}

OniStatus TestDevice::tryManualTrigger() {
    if (shared_.settings.fast) Tick();
    return ONI_STATUS_OK;
}

void TestDevice::Run(const std::stop_token& stop) {
    std::mutex sleep_mutex;
    std::uint64_t first_us = 0;
    const auto begin = std::chrono::steady_clock::now();
    FeedFrame next;
    for (bool alive = true; alive && !stop.stop_requested(); alive = Tick()) {
        shared_.feed->Get(shared_.next, next);
        if (first_us == 0) first_us = next.stamp_us;
        std::unique_lock lock(sleep_mutex);
        wake_.wait_until(lock, stop, begin + std::chrono::microseconds(next.stamp_us - first_us),
                         [] { return false; });
    }
}

bool TestDevice::Tick() {
    const DeviceSettings& s = shared_.settings;
    const auto now = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    if (gone_) return false;
    if (now < stalled_until_) return true;
    const int number = shared_.next++;
    if ((number == s.vanish_at ||
         (s.vanish_every > 0 && number > 0 && number % s.vanish_every == 0)) &&
        number > shared_.vanished_at) {
        gone_ = true;
        shared_.vanished_at = number;
        lock.unlock();
        vanish_();
        return false;
    }
    if (number == s.stall_at) {
        stalled_until_ = now + std::chrono::milliseconds(s.stall_ms);
        return true;
    }
    shared_.feed->Get(number, frame_);
    if (!ticked_) first_us_ = frame_.stamp_us;
    ticked_ = true;
    const std::uint64_t stamp_us = frame_.stamp_us - first_us_ + 1000000;
    if (depth_ != nullptr) depth_->Give(frame_, number, stamp_us, FaultOf(s, number, true));
    const auto colour_us =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(stamp_us) + s.colour_delay_us);
    if (colour_ != nullptr && number % s.colour_every == 0)
        colour_->Give(frame_, number, colour_us, FaultOf(s, number, false));
    return true;
}

}  // namespace tessera::test_device
