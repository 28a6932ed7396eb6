#include "semantics/label_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "semantics/depth_segment.h"

namespace tessera {
namespace {

constexpr float kSameBox = 0.8f;

bool IsSecondOpinion(std::span<const Detection> detections, std::size_t i) {
    return std::any_of(detections.begin(), detections.begin() + static_cast<std::ptrdiff_t>(i), [&](const Detection& other) {
        return other.class_id != detections[i].class_id && BoxOverlap(other.box, detections[i].box) > kSameBox;
    });
}

void FindObject(const DepthImage& depth_m, const PinholeCamera& camera, const Detection& detection, const PixelBox& box,
                LabelRegion region, Image<std::uint8_t>& mask) {
    const bool has_mask = detection.mask.width() == box.width() && detection.mask.height() == box.height();
    if (region == LabelRegion::kMeanDepth)
        SegmentByMeanDepth(depth_m, box, mask);
    else if (has_mask)
        mask = detection.mask;
    else
        SegmentByDepth(depth_m, camera, box, mask);
}

}  // namespace

void MakeLabelImage(const DepthImage& depth_m, const PinholeCamera& camera, std::span<const Detection> detections,
                    LabelRegion region, LabelImage& labels) {
    labels.detection = Image<std::uint8_t>(depth_m.width(), depth_m.height(), 0);
    const std::size_t count = std::min(detections.size(), LabelImage::kMostDetections);
    std::vector<PixelBox> boxes(count);
    std::vector<Image<std::uint8_t>> masks(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        if (IsSecondOpinion(detections, i)) return;
        boxes[i] = PixelsOf(detections[i].box, depth_m.width(), depth_m.height());
        if (!boxes[i].empty()) FindObject(depth_m, camera, detections[i], boxes[i], region, masks[i]);
    });
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return boxes[i].width() * boxes[i].height(); });
    for (const std::size_t i : order)
        for (int y = 0; y < boxes[i].height(); ++y)
            for (int x = 0; x < boxes[i].width(); ++x) {
                std::uint8_t& pixel = labels.detection(x + boxes[i].x_begin, y + boxes[i].y_begin);
                if (masks[i](x, y) != 0)
                    pixel = static_cast<std::uint8_t>(i + 1);
                else if (pixel == 0)
                    pixel = LabelImage::kBesideObjects;
            }
}

}  // namespace tessera
