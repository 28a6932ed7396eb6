// A simulated depth camera: one device of the test driver, with its two streams.
#pragma once

#include <Driver/OniDriverAPI.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "openni/device_feed.h"
#include "openni/device_settings.h"

namespace tessera::test_device {

class TestDevice;

class TestStream : public oni::driver::StreamBase {
  public:
    TestStream(TestDevice& device, bool depth);
    OniStatus setProperty(int id, const void* data, int size) override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniBool isPropertySupported(int id) override;
    OniStatus start() override;
    void stop() override;

    bool depth() const { return depth_; }
    // Passes the image to the runtime if the stream is running.
    void Give(const FeedFrame& frame, int number, std::uint64_t stamp_us, Fault fault);

  private:
    void Fill(const FeedFrame& frame, const OniVideoMode& mode, int number, Fault fault,
              OniFrame& image) const;

    TestDevice& device_;
    const bool depth_;
    // Two mutexes, because the runtime reads properties under a lock that it also takes when it
    // receives a frame.
    std::mutex giving_;  // guards running_; once stop returns, no frame is being passed on
    bool running_ = false;
    std::mutex mutex_;  // guards the members below
    OniVideoMode mode_;
    OniBool mirror_ = TRUE, auto_exposure_ = TRUE, auto_white_balance_ = TRUE;
};

class TestDevice : public oni::driver::DeviceBase {
  public:
    // State that survives when devices are unplugged and return.
    struct Shared {
        DeviceSettings settings;
        std::unique_ptr<DeviceFeed> feed;
        int next = 0;          // number of the next frame
        int vanished_at = -1;  // it vanishes only once at a frame
        std::function<void(const std::string&)> log;
    };

    // `vanish` is called when the device is unplugged.
    TestDevice(Shared& shared, std::function<void()> vanish);
    ~TestDevice() override;

    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
    oni::driver::StreamBase* createStream(OniSensorType type) override;
    void destroyStream(oni::driver::StreamBase* stream) override;
    OniStatus setProperty(int id, const void* data, int size) override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniBool isPropertySupported(int id) override {
        return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
    }
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override;
    // The runtime calls this while a client waits for a frame. Used with PACE=fast.
    OniStatus tryManualTrigger() override;

    Shared& shared() { return shared_; }
    OniVideoMode Mode(bool depth, bool small) const;
    void Started();

  private:
    void Run(const std::stop_token& stop);
    // Passes the next frame's images to the running streams. Returns false once the device has
    // vanished.
    bool Tick();

    Shared& shared_;
    std::function<void()> vanish_;
    std::mutex mutex_;  // guards the streams and the ticking
    std::condition_variable_any wake_;
    TestStream* depth_ = nullptr;
    TestStream* colour_ = nullptr;
    FeedFrame frame_;
    std::uint64_t first_us_ = 0;  // the feed's stamp that maps to second 1 of this device
    bool ticked_ = false, gone_ = false;
    std::chrono::steady_clock::time_point begin_, stalled_until_;
    int registration_ = ONI_IMAGE_REGISTRATION_OFF;
    OniVideoMode modes_[2][2];
    OniSensorInfo sensors_[2];
    std::jthread thread_;  // last member: stops before the others are destroyed
};

}  // namespace tessera::test_device
