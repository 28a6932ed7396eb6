#include "run/run_corrections.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tessera {
namespace {

using RecordJson = nlohmann::json;

// The number there, or 0.
double NumberAt(const RecordJson& json, const std::string& pointer) {
    const RecordJson::json_pointer at(pointer);
    return json.contains(at) && json[at].is_number() ? json[at].get<double>() : 0;
}

int PixelsAt(const RecordJson& json, const std::string& pointer) {
    constexpr double kMost = 1e6;
    return static_cast<int>(std::clamp(NumberAt(json, pointer), 0.0, kMost));
}

bool IsUsed(const RecordJson& json, const std::string& correction) {
    const RecordJson::json_pointer used("/" + correction + "/used");
    return json.contains(used) && json[used].is_boolean() && json[used].get<bool>();
}

}  // namespace

void UseCorrections(const std::string& run_json, RunConfig& config) {
    const RecordJson json = RecordJson::parse(run_json, nullptr, false);
    if (!json.is_object()) return;
    PinholeCamera camera;
    const std::string source = "/source/camera/";
    camera.width = PixelsAt(json, source + "width");
    camera.height = PixelsAt(json, source + "height");
    camera.fx = NumberAt(json, source + "fx");
    camera.fy = NumberAt(json, source + "fy");
    camera.cx = NumberAt(json, source + "cx");
    camera.cy = NumberAt(json, source + "cy");
    if (CheckPlausible(camera).ok()) config.source.camera = camera;
    if (IsUsed(json, "vignetting")) config.source.vignetting = NumberAt(json, "/vignetting/share");
    if (IsUsed(json, "colour_shift"))
        config.source.colour_shift_px = {NumberAt(json, "/colour_shift/x_px"),
                                         NumberAt(json, "/colour_shift/y_px")};
}

}  // namespace tessera
