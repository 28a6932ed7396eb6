// Finds depth cameras on the USB bus by the vendor and product ids that Linux reports. Needs no
// driver, so it can tell a camera that is plugged in but unusable from one that is not there.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "io/openni_devices.h"

namespace tessera {
namespace {

struct Kind {
    const char *vendor, *product;  // empty product: any
    const char* name;
    bool needs_freenect;
};

constexpr std::array<Kind, 5> kKinds = {{
    {"1d27", "0609", "ASUS Xtion 2 or PrimeSense camera", false},
    {"1d27", "", "PrimeSense or ASUS Xtion camera", false},
    {"045e", "02ae", "Microsoft Kinect (Xbox 360)", true},
    {"045e", "02bf", "Microsoft Kinect for Windows", true},
    {"2bc5", "", "Orbbec camera (needs the vendor's OpenNI2 driver)", false},
}};

std::string FirstWord(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string word;
    stream >> word;
    return word;
}

}  // namespace

std::vector<UsbCamera> FindUsbCameras(const std::string& sys_devices, const std::string& dev_bus) {
    std::vector<UsbCamera> cameras;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(sys_devices, error)) {
        const std::string vendor = FirstWord(entry.path() / "idVendor"),
                          product = FirstWord(entry.path() / "idProduct");
        const auto kind = std::ranges::find_if(kKinds, [&](const Kind& k) {
            return vendor == k.vendor && (*k.product == 0 || product == k.product);
        });
        if (kind == kKinds.end()) continue;
        const auto three_digits = [&](const char* file) {
            const std::string number = FirstWord(entry.path() / file);
            return std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number;
        };
        UsbCamera camera;
        camera.name = kind->name;
        camera.path = dev_bus + "/" + three_digits("busnum") + "/" + three_digits("devnum");
        camera.writable = access(camera.path.c_str(), R_OK | W_OK) == 0;
        camera.needs_freenect = kind->needs_freenect;
        cameras.push_back(camera);
    }
    std::ranges::sort(cameras, {}, &UsbCamera::path);
    return cameras;
}

}  // namespace tessera
