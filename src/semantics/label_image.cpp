#include "semantics/label_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "semantics/depth_segment.h"

namespace tessera {
namespace {

constexpr float kSameBox = 0.8f;

bool IsSecondOpinion(std::span<const Detection> detections, std::size_t i) {
    return std::any_of(detections.begin(), detections.begin() + static_cast<std::ptrdiff_t>(i),
                       [&](const Detection& other) {
                           return other.class_id != detections[i].class_id &&
                                  BoxOverlap(other.box, detections[i].box) > kSameBox;
                       });
}

// Returns the other boxes, except those that contain most of this one: an object's support may
// itself be an object.
std::vector<PixelBox> Neighbours(const std::vector<PixelBox>& boxes, const PixelBox& box) {
    std::vector<PixelBox> neighbours;
    for (const PixelBox& other : boxes) {
        const int width = std::min(box.x_end, other.x_end) - std::max(box.x_begin, other.x_begin);
        const int height = std::min(box.y_end, other.y_end) - std::max(box.y_begin, other.y_begin);
        const bool holds =
            width > 0 && height > 0 && 2 * width * height > box.width() * box.height();
        if (!other.empty() && !holds) neighbours.push_back(other);
    }
    return neighbours;
}

void FindObject(const DepthImage& depth_m, const PinholeCamera& camera, const Detection& detection,
                const std::vector<PixelBox>& boxes, const PixelBox& box, LabelRegion region,
                Image<std::uint8_t>& mask) {
    const bool has_mask =
        detection.mask.width() == box.width() && detection.mask.height() == box.height();
    if (region == LabelRegion::kMeanDepth)
        SegmentByMeanDepth(depth_m, box, mask);
    else if (has_mask)
        mask = detection.mask;
    else
        SegmentByDepth(depth_m, camera, box, Neighbours(boxes, box), mask);
}

}  // namespace

void MakeLabelImage(const DepthImage& depth_m, const PinholeCamera& camera,
                    std::span<const Detection> detections, LabelRegion region, LabelImage& labels) {
    labels.detection = labels.second = Image<std::uint8_t>(depth_m.width(), depth_m.height(), 0);
    const std::size_t count = std::min(detections.size(), LabelImage::kMostDetections);
    std::vector<PixelBox> boxes(count);
    std::vector<Image<std::uint8_t>> masks(count);
    for (std::size_t i = 0; i < count; ++i)
        if (!IsSecondOpinion(detections, i))
            boxes[i] = PixelsOf(detections[i].box, depth_m.width(), depth_m.height());
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        if (!boxes[i].empty())
            FindObject(depth_m, camera, detections[i], boxes, boxes[i], region, masks[i]);
    });
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::size_t i) { return boxes[i].width() * boxes[i].height(); });
    for (const std::size_t i : order)
        for (int y = 0; y < boxes[i].height(); ++y)
            for (int x = 0; x < boxes[i].width(); ++x) {
                const int u = x + boxes[i].x_begin, v = y + boxes[i].y_begin;
                std::uint8_t& pixel = labels.detection(u, v);
                if (masks[i](x, y) != 0) {
                    if (pixel != LabelImage::kBesideObjects) labels.second(u, v) = pixel;
                    pixel = static_cast<std::uint8_t>(i + 1);
                } else if (pixel == 0) {
                    pixel = LabelImage::kBesideObjects;
                }
            }
}

}  // namespace tessera
