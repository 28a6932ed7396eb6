#include "semantics/label_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "render/annotation.h"

namespace tessera {
namespace {

constexpr Rgb8 kBeside{70, 70, 70};
constexpr Rgb8 kNoObject{0, 0, 0};

ColourImage DetectionsPicture(const LabelViews& views, const LabelClasses& classes, int width,
                              int height) {
    ColourImage picture = views.colour.empty() ? ColourImage(width, height) : views.colour;
    const auto pixel = [](float x) {
        return static_cast<int>(std::lround(std::clamp(x, -1e4f, 1e4f)));
    };
    for (const Detection& d : views.detections)
        DrawRectangle(pixel(d.box.x_min), pixel(d.box.y_min), pixel(d.box.x_max),
                      pixel(d.box.y_max), classes.colour(d.class_id), picture);
    for (const Detection& d : views.detections)
        DrawPlate(pixel((d.box.x_min + d.box.x_max) / 2), pixel(d.box.y_min),
                  fmt::format("{} {:.2f}", classes.name(d.class_id), d.probability),
                  classes.colour(d.class_id), picture);
    return picture;
}

ColourImage ObjectsPicture(const LabelViews& views, const LabelClasses& classes) {
    const Image<std::uint8_t>& numbers = views.objects.detection;
    ColourImage picture(numbers.width(), numbers.height(), kNoObject);
    std::transform(numbers.data(), numbers.data() + numbers.size(), picture.data(),
                   [&](std::uint8_t number) {
                       if (number == 0) return kNoObject;
                       if (number == LabelImage::kBesideObjects) return kBeside;
                       return classes.colour(views.detections[number - 1u].class_id);
                   });
    return picture;
}

ColourImage PredictedObjects(const Image<VertexLabel>& predicted, const LabelClasses& classes) {
    struct Place {
        int x_min = std::numeric_limits<int>::max(), x_max = 0;
        int y_min = std::numeric_limits<int>::max();
        int class_id = 0;
    };
    std::map<int, Place> places;  // by the object's number
    ColourImage picture(predicted.width(), predicted.height(), kNoObject);
    for (int y = 0; y < predicted.height(); ++y)
        for (int x = 0; x < predicted.width(); ++x) {
            const VertexLabel& label = predicted(x, y);
            if (label.class_id == 0) continue;
            picture(x, y) = classes.colour(label.class_id);
            Place& place = places[label.instance];
            place.x_min = std::min(place.x_min, x);
            place.x_max = std::max(place.x_max, x);
            place.y_min = std::min(place.y_min, y);
            place.class_id = label.class_id;
        }
    for (const auto& [number, place] : places)
        DrawPlate((place.x_min + place.x_max) / 2, place.y_min,
                  fmt::format("{} {}", classes.name(place.class_id), number),
                  classes.colour(place.class_id), picture);
    return picture;
}

}  // namespace

ColourImage LabelPicture(const LabelViews& views, const LabelClasses& classes) {
    const int width = views.predicted.width(), height = views.predicted.height();
    PictureSheet sheet(2, 2, width, height);
    sheet.Put(0, 0, "detections", DetectionsPicture(views, classes, width, height));
    sheet.Put(1, 0, "object image, grey: votes for the background", ObjectsPicture(views, classes));
    sheet.Put(0, 1, "predicted colour", views.predicted_colour);
    sheet.Put(1, 1, "predicted object image", PredictedObjects(views.predicted, classes));
    return sheet.Take();
}

}  // namespace tessera
