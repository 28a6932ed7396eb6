#include "io/openni_devices.h"

#include <OniCAPI.h>
#include <OpenNI.h>
#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/openni_runtime.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSettings = "/etc/openni2/OpenNI.ini";

// The folder where the library looks for drivers: next to itself, or as its settings file says.
std::string DriverFolder() {
    Dl_info about{};
    std::error_code error;
    if (dladdr(reinterpret_cast<const void*>(&oniInitialize), &about) == 0 ||
        about.dli_fname == nullptr)
        return {};
    const fs::path base = fs::canonical(about.dli_fname, error).parent_path();
    std::ifstream settings(kSettings);
    for (std::string line; std::getline(settings, line);)
        if (const std::string key = "Repository="; line.starts_with(key))
            return (base / line.substr(key.size())).string();
    return (base / "OpenNI2" / "Drivers").string();
}

bool HasDriver(const std::string& folder, const std::string& part) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().filename().string().find(part) != std::string::npos) return true;
    return false;
}

// `library`: the package with the camera's rules, without its version.
bool HasUdevRules(const std::string& library) {
    std::error_code error;
    for (const char* folder : {"/lib/udev/rules.d", "/usr/lib/udev/rules.d", "/etc/udev/rules.d"})
        for (const auto& entry : fs::directory_iterator(folder, error)) {
            const std::string name = entry.path().filename().string();
            if (name.find(library) != std::string::npos) return true;
        }
    return false;
}

void AdviseOn(const UsbCamera& camera, const std::string& driver_folder,
              std::vector<std::string>& advice) {
    advice.push_back(fmt::format("on USB: {}, {}", camera.name, camera.path));
    if (!camera.writable)
        advice.push_back(
            HasUdevRules(camera.needs_freenect ? "freenect" : "openni")
                ? "  no permission to use it: unplug it and plug it in again so that the udev "
                  "rules "
                  "apply"
                : fmt::format("  no permission to use it: udev rules are missing; install the "
                              "package {} and plug it in again",
                              camera.needs_freenect ? "libfreenect0.5" : "libopenni2-0"));
    else if (camera.needs_freenect && !HasDriver(driver_folder, "Freenect"))
        advice.push_back("  needs the driver libTesseraFreenect.so.0 (see docs/camera.md) in " +
                         driver_folder);
    else
        advice.push_back(
            "  it does not respond: is another program using it? If not, plug it in again, at "
            "another port");
}

std::vector<std::string> Advise(const std::string& driver_folder) {
    const char* const sys_devices = "/sys/bus/usb/devices";
    std::vector<std::string> advice;
    std::error_code error;
    if (!HasDriver(driver_folder, "lib"))
        advice.push_back("no drivers in " + driver_folder +
                         " (install the package libopenni2-0, or correct " + kSettings + ")");
    if (!fs::exists(sys_devices, error)) {
        advice.push_back(
            "no USB bus visible (in a container? pass /dev/bus/usb and /sys through to it)");
        return advice;
    }
    const std::vector<UsbCamera> cameras = FindUsbCameras(sys_devices, "/dev/bus/usb");
    if (cameras.empty())
        advice.push_back(
            "no known depth camera on USB: is it plugged in, and its power supply as well?");
    for (const UsbCamera& camera : cameras) AdviseOn(camera, driver_folder, advice);
    return advice;
}

}  // namespace

Result<std::string> FindOpenniDevice(const std::string& name,
                                     const std::vector<OpenniDevice>& devices) {
    if (devices.empty())
        return Status::Error(name +
                             ": no camera found; is it plugged in, and do you have permission to "
                             "use it? tessera doctor gives details");
    const std::string uri = name.substr(std::string(kOpenniPrefix).size());
    if (uri.empty()) return devices.front().uri;
    if (std::ranges::find(devices, uri, &OpenniDevice::uri) == devices.end())
        return Status::Error(name + ": no such camera; tessera doctor lists the cameras");
    return uri;
}

bool IsSameOpenniKind(const std::string& uri, const std::string& other) {
    return uri == other || (other.find('@') != std::string::npos &&
                            uri.substr(0, uri.find('@')) == other.substr(0, other.find('@')));
}

OpenniListing ListOpenniDevices() {
    OpenniListing listing;
    listing.built_in = true;
    const openni::Version version = openni::OpenNI::getVersion();
    listing.version = fmt::format("{}.{}.{}", version.major, version.minor, version.maintenance);
    listing.driver_folder = DriverFolder();
    const Result<std::shared_ptr<OpenniRuntime>> runtime = OpenniRuntime::Acquire();
    if (!runtime.ok()) listing.advice.push_back(runtime.message());
    if (runtime.ok()) listing.devices = runtime.value()->Devices();
    if (listing.devices.empty())
        for (std::string& line : Advise(listing.driver_folder))
            listing.advice.push_back(std::move(line));
    return listing;
}

}  // namespace tessera
