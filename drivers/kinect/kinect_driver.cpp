// An OpenNI2 driver for the Kinects that OpenNI2's own drivers do not support. OpenNI2 loads it
// from its folder of drivers; Tessera then sees these cameras as openni2:.
#include <cstdio>
#include <map>
#include <string>

#include "kinect/kinect.h"

namespace tessera::kinect {
namespace {

constexpr const char* kScheme = "freenect://";

class KinectDriver : public oni::driver::DriverBase {
  public:
    explicit KinectDriver(OniDriverServices* services) : DriverBase(services) {}

    OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                         oni::driver::DeviceDisconnectedCallback disconnected,
                         oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
        DriverBase::initialize(connected, disconnected, changed, cookie);
        const bool started = usb_.Start([this](const auto& came, const auto& went) {
            for (const std::string& serial : went) deviceDisconnected(&InfoOf(serial));
            for (const std::string& serial : came) deviceConnected(&InfoOf(serial));
        });
        return started ? ONI_STATUS_OK : ONI_STATUS_ERROR;
    }

    oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
        const std::string text = uri;
        if (!text.starts_with(kScheme)) return nullptr;
        return Kinect::Open(usb_, text.substr(std::string(kScheme).size())).release();
    }
    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
    void shutdown() override { usb_.Stop(); }

  private:
    // The runtime may keep the address, so it stays.
    OniDeviceInfo& InfoOf(const std::string& serial) {
        const auto [at, is_new] = infos_.try_emplace(serial);
        OniDeviceInfo& info = at->second;
        if (!is_new) return info;
        info = {};
        std::snprintf(info.uri, sizeof(info.uri), "%s%s", kScheme, serial.c_str());
        std::snprintf(info.vendor, sizeof(info.vendor), "Microsoft");
        std::snprintf(info.name, sizeof(info.name), "Kinect");
        info.usbVendorId = 0x045e;
        info.usbProductId = 0x02ae;
        return info;
    }

    std::map<std::string, OniDeviceInfo> infos_;
    UsbThread usb_;
};

}  // namespace
}  // namespace tessera::kinect

// OpenNI2's macro uses allocation macros of a library that is not published with it.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(object) delete (object)
ONI_EXPORT_DRIVER(tessera::kinect::KinectDriver)
