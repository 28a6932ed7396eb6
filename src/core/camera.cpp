#include "core/camera.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <set>

namespace tessera {
namespace {

Status NotPlausible(const char* key, double value) {
    return Status::Error(fmt::format("{}: {} is not plausible", key, value));
}

Status CheckPlausible(const CameraCalibration& c) {
    if (Status status = CheckPlausible(c.pinhole); !status.ok()) return status;
    const LensDistortion& d = c.distortion;
    for (const double k : {d.k1, d.k2, d.p1, d.p2, d.k3})
        if (!std::isfinite(k)) return NotPlausible("distortion", k);
    if (!(c.depth_scale > 0 && c.depth_scale < 1e7))
        return NotPlausible("depth_scale", c.depth_scale);
    if (!(c.fps > 0 && c.fps < 1e4)) return NotPlausible("fps", c.fps);
    return Status::Ok();
}

}  // namespace

Status CheckPlausible(const PinholeCamera& p) {
    for (const auto& [key, value] : std::map<const char*, double>{{"fx", p.fx}, {"fy", p.fy}})
        if (!(value > 1.0 && value < 1e5)) return NotPlausible(key, value);
    if (p.width < 16 || p.width > 8192) return NotPlausible("width", p.width);
    if (p.height < 16 || p.height > 8192) return NotPlausible("height", p.height);
    if (!(std::abs(p.cx) < 2.0 * p.width)) return NotPlausible("cx", p.cx);
    if (!(std::abs(p.cy) < 2.0 * p.height)) return NotPlausible("cy", p.cy);
    return Status::Ok();
}

Result<CameraCalibration> ReadCameraFile(const std::string& path) {
    CameraCalibration c;
    PinholeCamera& p = c.pinhole;
    std::map<std::string, double*> numbers = {{"fx", &p.fx},
                                              {"fy", &p.fy},
                                              {"cx", &p.cx},
                                              {"cy", &p.cy},
                                              {"depth_scale", &c.depth_scale},
                                              {"fps", &c.fps}};
    std::map<std::string, int*> sizes = {{"width", &p.width}, {"height", &p.height}};
    std::set<std::string> missing = {"fx", "fy", "cx", "cy"};
    std::string key = "?";
    try {
        const YAML::Node root = YAML::LoadFile(path);
        if (!root.IsMap()) return Status::Error(path + ": expected 'key: value' lines");
        for (const auto& entry : root) {
            key = entry.first.as<std::string>();
            missing.erase(key);
            if (numbers.count(key)) {
                *numbers[key] = entry.second.as<double>();
            } else if (sizes.count(key)) {
                *sizes[key] = entry.second.as<int>();
            } else if (key == "distortion") {
                const auto k = entry.second.as<std::vector<double>>();
                if (k.size() != 4 && k.size() != 5)
                    return Status::Error(path +
                                         ": distortion: needs k1, k2, p1, p2 and optionally k3");
                c.distortion = {k[0], k[1], k[2], k[3], k.size() == 5 ? k[4] : 0.0};
            } else {
                return Status::Error(fmt::format(
                    "{}: unknown key '{}' (known: width, height, fx, fy, cx, cy, distortion, "
                    "depth_scale, fps)",
                    path, key));
            }
        }
    } catch (const YAML::BadFile&) {
        return Status::Error(path + ": cannot be read");
    } catch (const YAML::Exception& error) {
        return Status::Error(fmt::format("{}: {}: {}", path, key, error.what()));
    }
    if (!missing.empty())
        return Status::Error(fmt::format("{}: '{}' is missing", path, *missing.begin()));
    // ICL-NUIM's intrinsics have the y axis pointing up, but its images do not.
    p.fy = std::abs(p.fy);
    if (Status status = CheckPlausible(c); !status.ok())
        return Status::Error(path + ": " + status.message());
    return c;
}

std::string CameraFileText(const CameraCalibration& calibration) {
    const PinholeCamera& p = calibration.pinhole;
    const LensDistortion& d = calibration.distortion;
    const std::string lens = d.IsZero() ? ""
                                        : fmt::format("distortion: [{}, {}, {}, {}, {}]\n", d.k1,
                                                      d.k2, d.p1, d.p2, d.k3);
    return fmt::format(
        "width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\n{}depth_scale: {}\nfps: {}\n",
        p.width, p.height, p.fx, p.fy, p.cx, p.cy, lens, calibration.depth_scale, calibration.fps);
}

}  // namespace tessera
