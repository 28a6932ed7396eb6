#include "semantics/yolo_outputs.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kStrides[] = {8, 16, 32};
constexpr int kMaskCoefficients = 32;

int CellsOf(int input_px) {
    int cells = 0;
    for (const int stride : kStrides) cells += (input_px / stride) * (input_px / stride);
    return cells;
}

std::string ShapeText(const std::vector<OutputArray>& outputs) {
    std::string text;
    for (const OutputArray& output : outputs) {
        text += text.empty() ? "" : ", ";
        for (std::size_t i = 0; i < output.shape.size(); ++i)
            text += fmt::format("{}{}", i > 0 ? "x" : "", output.shape[i]);
    }
    return text.empty() ? "none" : text;
}

bool IsMaskOutput(const OutputArray& output, int input_px) {
    return output.shape.size() == 4 && output.shape[0] == 1 &&
           output.shape[1] == kMaskCoefficients && output.shape[2] == input_px / 4 &&
           output.shape[3] == input_px / 4;
}

// Layout of a single boxes output; classes < 1: not recognised.
YoloLayout LayoutOf(const OutputArray& output, int input_px, bool with_masks) {
    YoloLayout layout;
    layout.input_px = input_px;
    if (output.shape.size() != 3 || output.shape[0] != 1) return layout;
    const int rows = output.shape[1], columns = output.shape[2], cells = CellsOf(input_px);
    const int masks = with_masks ? kMaskCoefficients : 0;
    if (rows == cells) {
        layout.family = ModelFamily::kYolox;
        layout.classes = columns - 5;
    } else if (rows == 3 * cells) {
        layout.family = ModelFamily::kYolov5;
        layout.classes = columns - 5 - masks;
        layout.mask_coefficients = masks;
    } else if (columns == cells) {
        layout.family = ModelFamily::kYolov8;
        layout.classes = rows - 4 - masks;
        layout.mask_coefficients = masks;
    }
    return layout;
}

bool IsDarknet(const std::vector<OutputArray>& outputs) {
    return !outputs.empty() && std::ranges::all_of(outputs, [&](const OutputArray& output) {
        return output.shape.size() == 2 && output.shape[0] > 1 && output.shape[1] > 5 &&
               output.shape[1] == outputs[0].shape[1];
    });
}

struct BestClass {
    int index = 0;
    float probability = 0;
};
BestClass FindBest(const float* scores, int count, int step) {
    BestClass best;
    for (int c = 0; c < count; ++c)
        if (scores[c * step] > best.probability) best = {c, scores[c * step]};
    return best;
}

void Append(BestClass best, float cx, float cy, float width, float height,
            std::vector<RawDetection>& found) {
    RawDetection d{best.index,
                   std::min(best.probability, 1.0f),
                   cx - width / 2,
                   cy - height / 2,
                   cx + width / 2,
                   cy + height / 2,
                   {}};
    if (std::isfinite(d.x_min) && std::isfinite(d.y_min) && std::isfinite(d.x_max) &&
        std::isfinite(d.y_max))
        found.push_back(std::move(d));
}

// Rows are (cx, cy, width, height, objectness, scores...), scaled by `scale`. Mask coefficients
// follow if there are masks.
void DecodeRows(const OutputArray& output, int rows, const YoloLayout& layout, float scale,
                float least, std::vector<RawDetection>& found) {
    const int columns = output.shape.back();
    for (int r = 0; r < rows; ++r) {
        const float* row = output.data + static_cast<std::ptrdiff_t>(r) * columns;
        BestClass best = FindBest(row + 5, layout.classes, 1);
        // Darknet's scores already include the objectness.
        if (layout.family != ModelFamily::kDarknet) best.probability *= row[4];
        if (!(best.probability >= least)) continue;
        const std::size_t before = found.size();
        Append(best, row[0] * scale, row[1] * scale, row[2] * scale, row[3] * scale, found);
        if (found.size() > before && layout.mask_coefficients > 0)
            found.back().mask_coefficients.assign(
                row + 5 + layout.classes, row + 5 + layout.classes + layout.mask_coefficients);
    }
}

void DecodeYolox(const OutputArray& output, const YoloLayout& layout, float least,
                 std::vector<RawDetection>& found) {
    const float* row = output.data;
    for (const int stride : kStrides) {
        const int side = layout.input_px / stride;
        const float s = static_cast<float>(stride);
        for (int cell = 0; cell < side * side; ++cell, row += output.shape[2]) {
            BestClass best = FindBest(row + 5, layout.classes, 1);
            best.probability *= row[4];
            if (!(best.probability >= least)) continue;
            Append(best, (row[0] + static_cast<float>(cell % side)) * s,
                   (row[1] + static_cast<float>(cell / side)) * s, std::exp(row[2]) * s,
                   std::exp(row[3]) * s, found);
        }
    }
}

void DecodeYolov8(const OutputArray& output, const YoloLayout& layout, float least,
                  std::vector<RawDetection>& found) {
    const int count = output.shape[2];
    for (int i = 0; i < count; ++i) {
        const float* column = output.data + i;
        const BestClass best = FindBest(column + 4 * count, layout.classes, count);
        if (!(best.probability >= least)) continue;
        const std::size_t before = found.size();
        Append(best, column[0], column[count], column[2 * count], column[3 * count], found);
        for (int m = 0; found.size() > before && m < layout.mask_coefficients; ++m)
            found.back().mask_coefficients.push_back(column[(4 + layout.classes + m) * count]);
    }
}

// Two neighbouring cells of the prototypes and the second one's part.
struct CellMix {
    int first = 0, second = 0;
    float part = 0;
};
CellMix MixAt(double input_px, int side) {
    const double cell = std::clamp(input_px / 4 - 0.5, 0.0, side - 1.0);
    const int first = static_cast<int>(cell);
    return {first, std::min(first + 1, side - 1), static_cast<float>(cell - first)};
}

}  // namespace

Result<YoloLayout> RecogniseOutputs(const std::vector<OutputArray>& outputs, int input_px,
                                    ModelFamily family) {
    const bool wants_darknet = family == ModelFamily::kDarknet || family == ModelFamily::kAuto;
    if (wants_darknet && IsDarknet(outputs))
        return YoloLayout{ModelFamily::kDarknet, input_px, outputs[0].shape[1] - 5, 0, 0, -1};
    int masks_output = -1;
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (IsMaskOutput(outputs[i], input_px)) masks_output = static_cast<int>(i);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        YoloLayout layout = LayoutOf(outputs[i], input_px, masks_output >= 0);
        if (layout.classes < 1 || (family != ModelFamily::kAuto && family != layout.family))
            continue;
        layout.boxes_output = static_cast<int>(i);
        layout.masks_output = layout.mask_coefficients > 0 ? masks_output : -1;
        return layout;
    }
    return Status::Error(fmt::format(
        "its outputs ({}) for an input of {} px are not those of a {} network", ShapeText(outputs),
        input_px,
        family == ModelFamily::kAuto ? "YOLOX, YOLOv5, YOLOv8 or Darknet" : "labels.family"));
}

std::vector<RawDetection> DecodeOutputs(const YoloLayout& layout,
                                        const std::vector<OutputArray>& outputs,
                                        float min_probability) {
    std::vector<RawDetection> found;
    const OutputArray& boxes = outputs[static_cast<std::size_t>(layout.boxes_output)];
    switch (layout.family) {
        case ModelFamily::kYolox: DecodeYolox(boxes, layout, min_probability, found); break;
        case ModelFamily::kYolov5:
            DecodeRows(boxes, boxes.shape[1], layout, 1, min_probability, found);
            break;
        case ModelFamily::kYolov8: DecodeYolov8(boxes, layout, min_probability, found); break;
        case ModelFamily::kAuto:  // never, once recognised
        case ModelFamily::kDarknet:
            for (const OutputArray& output : outputs)
                DecodeRows(output, output.shape[0], layout, static_cast<float>(layout.input_px),
                           min_probability, found);
    }
    return found;
}

void SuppressOverlaps(float overlap, std::vector<RawDetection>& detections) {
    std::ranges::stable_sort(detections, std::greater{}, &RawDetection::probability);
    const auto box = [](const RawDetection& d) {
        return DetectionBox{d.x_min, d.y_min, d.x_max - 1, d.y_max - 1};
    };
    std::vector<RawDetection> kept;
    for (RawDetection& d : detections)
        if (std::ranges::none_of(kept, [&](const RawDetection& k) {
                return k.class_index == d.class_index && BoxOverlap(box(k), box(d)) > overlap;
            }))
            kept.push_back(std::move(d));
    detections = std::move(kept);
}

Image<std::uint8_t> MaskOf(const YoloLayout& layout, const std::vector<OutputArray>& outputs,
                           const RawDetection& detection, const PixelBox& pixels, double scale_x,
                           double scale_y) {
    const OutputArray& prototypes = outputs[static_cast<std::size_t>(layout.masks_output)];
    const int side = prototypes.shape[2];
    std::vector<CellMix> columns, rows;
    for (int x = pixels.x_begin; x < pixels.x_end; ++x)
        columns.push_back(MixAt((x + 0.5) * scale_x, side));
    for (int y = pixels.y_begin; y < pixels.y_end; ++y)
        rows.push_back(MixAt((y + 0.5) * scale_y, side));
    Image<std::uint8_t> mask(pixels.width(), pixels.height(), 0);
    if (pixels.empty()) return mask;
    Image<float> logits(side, side, 0.0f);
    for (int m = 0; m < layout.mask_coefficients; ++m)
        for (int row = rows.front().first; row <= rows.back().second; ++row)
            for (int column = columns.front().first; column <= columns.back().second; ++column)
                logits(column, row) += detection.mask_coefficients[static_cast<std::size_t>(m)] *
                                       prototypes.data[(m * side + row) * side + column];
    for (int y = 0; y < mask.height(); ++y)
        for (int x = 0; x < mask.width(); ++x) {
            const CellMix &u = columns[static_cast<std::size_t>(x)],
                          &v = rows[static_cast<std::size_t>(y)];
            const float upper =
                            std::lerp(logits(u.first, v.first), logits(u.second, v.first), u.part),
                        lower = std::lerp(logits(u.first, v.second), logits(u.second, v.second),
                                          u.part);
            mask(x, y) = std::lerp(upper, lower, v.part) > 0;  // the sigmoid's 0.5
        }
    return mask;
}

}  // namespace tessera
