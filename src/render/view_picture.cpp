#include "render/view_picture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/check.h"
#include "render/annotation.h"

namespace tessera {
namespace {

constexpr float kFullDepth_m = 0.05f, kFullIntensity = 0.25f;
constexpr Rgb8 kMissingColour{150, 150, 150};

// Rec. 601, like the map's luma.
float Luma(const Rgb8& c) {
    return (0.299f * static_cast<float>(c.r) + 0.587f * static_cast<float>(c.g) +
            0.114f * static_cast<float>(c.b)) /
           255.0f;
}

// -1 is blue, 0 white, 1 red.
Rgb8 Signed(float value) {
    const float v = std::clamp(value, -1.0f, 1.0f);
    const auto faded = static_cast<std::uint8_t>(255.0f * (1.0f - std::abs(v)));
    return v > 0 ? Rgb8{255, faded, faded} : Rgb8{faded, faded, 255};
}

ColourImage DepthPicture(const DepthImage& depth_m, float nearest_m, float farthest_m) {
    cv::Mat bytes(depth_m.height(), depth_m.width(), CV_8U), colours;
    for (int v = 0; v < depth_m.height(); ++v)
        for (int u = 0; u < depth_m.width(); ++u) {
            const float share =
                (depth_m(u, v) - nearest_m) / std::max(farthest_m - nearest_m, 1e-3f);
            bytes.at<std::uint8_t>(v, u) =
                static_cast<std::uint8_t>(255.0f * std::clamp(1.0f - share, 0.0f, 1.0f));
        }
    cv::applyColorMap(bytes, colours, cv::COLORMAP_TURBO);
    ColourImage picture(depth_m.width(), depth_m.height());
    for (int v = 0; v < depth_m.height(); ++v)
        for (int u = 0; u < depth_m.width(); ++u) {
            const cv::Vec3b& bgr = colours.at<cv::Vec3b>(v, u);
            picture(u, v) = depth_m(u, v) > 0 ? Rgb8{bgr[2], bgr[1], bgr[0]} : Rgb8{};
        }
    return picture;
}

}  // namespace

ColourImage ViewPicture(const Frame& frame, const PredictedView& view, double gain, double offset,
                        const MovingMask* moving) {
    const int width = frame.depth_m.width(), height = frame.depth_m.height();
    TESSERA_CHECK(view.depth_m.width() == width && view.depth_m.height() == height,
                  "view of {} x {}, frame of {} x {}", view.depth_m.width(), view.depth_m.height(),
                  width, height);
    const ColourImage colour = frame.colour.empty() ? ColourImage(width, height) : frame.colour;
    ColourImage depth_error(width, height), intensity_error(width, height);
    float nearest_m = 100.0f, farthest_m = 0.0f;
    for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
            const float measured = frame.depth_m(u, v), predicted = view.depth_m(u, v);
            depth_error(u, v) = intensity_error(u, v) = kMissingColour;
            if (measured > 0) {
                nearest_m = std::min(nearest_m, measured);
                farthest_m = std::max(farthest_m, measured);
            }
            if (predicted <= 0) continue;
            if (measured > 0) depth_error(u, v) = Signed((predicted - measured) / kFullDepth_m);
            if (view.intensity(u, v) < 0 || frame.colour.empty()) continue;
            const float image =
                static_cast<float>(gain) * Luma(colour(u, v)) + static_cast<float>(offset);
            intensity_error(u, v) = Signed((view.intensity(u, v) - image) / kFullIntensity);
        }
    PictureSheet sheet(3, 2, width, height);
    ColourImage measured = colour;
    if (moving != nullptr) TintMoving(*moving, 1, measured);
    sheet.Put(0, 0, moving != nullptr ? "measured colour, magenta: moving" : "measured colour",
              measured);
    sheet.Put(1, 0, "measured depth", DepthPicture(frame.depth_m, nearest_m, farthest_m));
    sheet.Put(2, 0, "depth: red in front of map, blue behind, full at 5 cm", depth_error);
    sheet.Put(0, 1, "predicted colour", view.colour);
    sheet.Put(1, 1, "predicted depth", DepthPicture(view.depth_m, nearest_m, farthest_m));
    sheet.Put(2, 1, "intensity: red where the map is brighter, full at 0.25", intensity_error);
    return sheet.Take();
}

}  // namespace tessera
