#include "io/nominal_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/quantile.h"
#include "io/image_decoder.h"

namespace tessera {
namespace {

constexpr double kFieldOfView_rad = std::numbers::pi / 3;
constexpr double kMillimetres = 1000, kTum = 5000;  // common stored depth values of one metre
constexpr double kUsual_m = 1.5;                    // median depth of a room
constexpr double kNearest_m = 0.3, kFarthest_m = 8;

// TUM's files hold whole millimetres times five. Otherwise, choose the unit that makes the depth
// more typical of a room.
double UnitOf(const std::vector<std::uint16_t>& values, double middle) {
    if (middle <= 0) return kMillimetres;
    const bool fives = std::all_of(values.begin(), values.end(),
                                   [](std::uint16_t value) { return value % 5 == 0; });
    if (fives && middle >= kNearest_m * kTum && middle <= kFarthest_m * kTum) return kTum;
    const auto unusual = [&](double unit) { return std::abs(std::log(middle / unit / kUsual_m)); };
    return unusual(kTum) < unusual(kMillimetres) ? kTum : kMillimetres;
}

}  // namespace

PinholeCamera NominalPinhole(int width, int height) {
    const double f_px = 0.5 * width / std::tan(0.5 * kFieldOfView_rad);
    return {width, height, f_px, f_px, 0.5 * (width - 1), 0.5 * (height - 1)};
}

Status AssumeCamera(FolderLayout& layout, bool depth_scale_set) {
    constexpr std::size_t kProbes = 5, kEvery = 7;
    ImageDecoder decoder;
    Image<std::uint16_t> depth;
    std::vector<std::uint16_t> values;
    Status first;
    PinholeCamera camera{.width = 0};
    const std::size_t count = layout.frames.size(), probes = std::min(kProbes, count);
    for (std::size_t i = 0; i < probes; ++i) {
        if (Status status = decoder.ReadDepth(layout.frames[i * count / probes].depth_path, depth);
            !status.ok()) {
            if (first.ok()) first = std::move(status);
            continue;
        }
        if (camera.width == 0) camera.width = depth.width(), camera.height = depth.height();
        for (std::size_t k = 0; k < depth.size(); k += kEvery)
            if (const std::uint16_t value = depth.data()[k];
                value != 0 && value != layout.invalid_depth)
                values.push_back(value);
    }
    if (camera.width == 0) return first;
    camera = NominalPinhole(camera.width, camera.height);
    const double middle = values.empty() ? 0 : Median(values), unit = UnitOf(values, middle);
    layout.calibration.pinhole = camera;
    layout.calibration.depth_scale = unit;
    layout.camera_from = kNominalCamera;
    if (depth_scale_set) return Status::Ok();
    layout.notes.push_back(
        fmt::format("no camera.yaml: assuming depth_scale {:.0f}, which gives a median depth of "
                    "{:.2f} m; if that is wrong, set source.depth_scale",
                    unit, middle / unit));
    return Status::Ok();
}

PinholeCamera WithSizeOf(const PinholeCamera& sized, const PinholeCamera& values) {
    PinholeCamera camera = values;
    camera.width = sized.width;
    camera.height = sized.height;
    return camera;
}

}  // namespace tessera
