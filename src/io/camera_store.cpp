#include "io/camera_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "io/colour_registration.h"

namespace tessera {

std::string CalibrationPath(const std::string& serial) {
    if (serial.empty()) return "";
    std::string name = serial;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    if (config != nullptr && *config != '\0')
        return fmt::format("{}/tessera/cameras/{}.yaml", config, name);
    return home == nullptr ? "" : fmt::format("{}/.config/tessera/cameras/{}.yaml", home, name);
}

Result<std::optional<StoredCalibration>> FindCalibration(const std::string& named,
                                                         const std::string& serial, int width,
                                                         int height) {
    using Found = std::optional<StoredCalibration>;
    const std::string path = named.empty() ? CalibrationPath(serial) : named;
    std::error_code ignored;
    if (named == "none" || path.empty()) return Found();
    if (named.empty() && !std::filesystem::exists(path, ignored)) return Found();
    const Result<CameraCalibration> read = ReadCameraFile(path);
    if (!read.ok()) return read.status();
    const PinholeCamera& camera = read.value().pinhole;
    if (camera.width != width || camera.height != height)
        return Status::Error(fmt::format(
            "{}: is for images of {} x {}, but the camera delivers {} x {}; calibrate it again, or "
            "set source.openni.calibration=none",
            path, camera.width, camera.height, width, height));
    if (Status status = CheckOneSize(read.value()); !status.ok())
        return Status::Error(path + ": " + status.message());
    return Found(StoredCalibration{path, read.value()});
}

}  // namespace tessera
