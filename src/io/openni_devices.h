// Lists the OpenNI2 cameras of this machine. If there are none, explains why as far as possible.
#pragma once

#include <string>
#include <vector>

namespace tessera {

struct OpenniDevice {
    std::string uri;  // e.g. "1d27/0609@1/5"; with the prefix "openni2:" it names a source
    std::string name, vendor;
};

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
