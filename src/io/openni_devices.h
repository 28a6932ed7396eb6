// Lists the OpenNI2 cameras of this machine. If there are none, explains why as far as possible.
#pragma once

#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// Of the names of sources: "openni2:" is any camera, "openni2:URI" this one.
inline constexpr const char* kOpenniPrefix = "openni2:";

struct OpenniDevice {
    std::string uri;  // e.g. "1d27/0609@1/5"; with the prefix "openni2:" it names a source
    std::string name, vendor;
};

// Returns the URI of the device that a source's name stands for. Errors name the source.
Result<std::string> FindOpenniDevice(const std::string& name,
                                     const std::vector<OpenniDevice>& devices);
// True for the same device or one of the same kind. The part of a URI after "@" is the port.
bool IsSameOpenniKind(const std::string& uri, const std::string& other);

struct OpenniListing {
    bool built_in = false;      // this build has OpenNI2
    std::string version;        // of the OpenNI2 library
    std::string driver_folder;  // where the library looks for drivers
    std::vector<OpenniDevice> devices;
    // If there is no device: what is wrong or what to do, one line each.
    std::vector<std::string> advice;
};

// Initialises the OpenNI2 runtime if nobody has yet; that takes up to a second. Thread-safe.
OpenniListing ListOpenniDevices();

// A depth camera on the USB bus, identified by its vendor and product ids.
struct UsbCamera {
    std::string name;             // "Microsoft Kinect (Xbox 360)"
    std::string path;             // its device file
    bool writable = false;        // by this user; required to use the camera
    bool needs_freenect = false;  // OpenNI2's own drivers do not support it
};

// `sys_devices` is /sys/bus/usb/devices and `dev_bus` is /dev/bus/usb, or copies of them in tests.
std::vector<UsbCamera> FindUsbCameras(const std::string& sys_devices, const std::string& dev_bus);

}  // namespace tessera
