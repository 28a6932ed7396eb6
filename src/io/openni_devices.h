// Which OpenNI2 cameras this machine has, and if none, why as far as can be known.
#pragma once

#include <string>
#include <vector>

namespace tessera {

struct OpenniDevice {
    std::string uri;  // "1d27/0609@1/5": after "openni2:" it is a source's name
    std::string name, vendor;
};

struct OpenniListing {
    bool built_in = false;      // this build has OpenNI2
    std::string version;        // of the OpenNI2 library
    std::string driver_folder;  // where it looks for drivers
    std::vector<OpenniDevice> devices;
    // If there is no device: what is wrong or what to do, a line each.
    std::vector<std::string> advice;
};

// Initialises the OpenNI2 runtime if nobody has; takes up to a second then. Thread-safe.
OpenniListing ListOpenniDevices();

// A depth camera on the USB bus, known by its numbers.
struct UsbCamera {
    std::string name;             // "Microsoft Kinect (Xbox 360)"
    std::string path;             // its device file
    bool writable = false;        // by this user: needed to drive it
    bool needs_freenect = false;  // OpenNI2's own drivers do not know it
};

// `sys_devices`: /sys/bus/usb/devices, `dev_bus`: /dev/bus/usb, or copies of them in a test.
std::vector<UsbCamera> FindUsbCameras(const std::string& sys_devices, const std::string& dev_bus);

}  // namespace tessera
