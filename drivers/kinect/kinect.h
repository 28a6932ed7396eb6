// A Kinect for Xbox 360 or for Windows as an OpenNI2 device, through libfreenect: colour and depth
// of 640 x 480 pixels at 30 Hz.
#pragma once

#include <Driver/OniDriverAPI.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "kinect/usb_thread.h"

namespace tessera::kinect {

class Kinect;

// The runtime calls from any thread. Properties are read under a lock that the runtime takes also
// when it receives an image, so they must not wait for the USB thread.
class KinectStream : public oni::driver::StreamBase {
  public:
    KinectStream(Kinect& kinect, bool depth) : kinect_(kinect), depth_(depth) {}

    OniStatus setProperty(int id, const void* data, int size) override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniBool isPropertySupported(int id) override;
    OniStatus start() override;
    void stop() override;

    static OniVideoMode Mode(bool depth);
    // Passes an image on, under the USB lock.
    void Give(const void* pixels);

  private:
    Kinect& kinect_;
    const bool depth_;
    bool running_ = false;  // under the USB lock
    int number_ = 0;        // of the last image; under the USB lock
    std::mutex mutex_;      // guards the members below
    std::map<int, OniBool> switches_ = {{ONI_STREAM_PROPERTY_MIRRORING, FALSE},
                                        {ONI_STREAM_PROPERTY_AUTO_EXPOSURE, TRUE},
                                        {ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE, TRUE}};
};

class Kinect : public oni::driver::DeviceBase {
  public:
    // Null if the camera is gone or another program has it.
    static std::unique_ptr<Kinect> Open(UsbThread& usb, const std::string& serial);
    ~Kinect() override;

    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
    oni::driver::StreamBase* createStream(OniSensorType type) override;
    void destroyStream(oni::driver::StreamBase* stream) override;
    OniStatus setProperty(int id, const void* data, int size) override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniBool isPropertySupported(int id) override;
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

    UsbThread& usb() { return usb_; }
    freenect_device* device() { return device_; }
    // Whether depth is in the colour camera's view. A change acts when depth is started next.
    bool registered() const { return registered_; }

  private:
    Kinect(UsbThread& usb, std::string serial) : usb_(usb), serial_(std::move(serial)) {}

    UsbThread& usb_;
    const std::string serial_;
    freenect_device* device_ = nullptr;
    KinectStream *depth_ = nullptr, *colour_ = nullptr;  // under the USB lock
    std::atomic<bool> registered_ = false;
    OniVideoMode modes_[2] = {KinectStream::Mode(true), KinectStream::Mode(false)};
    OniSensorInfo sensors_[2] = {{ONI_SENSOR_DEPTH, 1, &modes_[0]},
                                 {ONI_SENSOR_COLOR, 1, &modes_[1]}};
};

}  // namespace tessera::kinect
