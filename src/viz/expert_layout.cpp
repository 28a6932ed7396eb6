#include "viz/expert_layout.h"

#include <algorithm>

#include "viz/theme.h"

namespace tessera {

ExpertLayout LayOutExpert(float width, float height, bool with_system, float time_line) {
    if (!with_system) {
        const float view = std::max(height - time_line, 1.0f);
        return {.left = {},
                .view = {0, 0, width, view},
                .plots = {},
                .images = {},
                .time_line = {0, view, width, time_line}};
    }
    const float left = std::min(Scaled(300), 0.4f * width),
                right = std::clamp(0.18f * width, Scaled(150), Scaled(232));
    const float plots = std::min(Scaled(158), 0.35f * height);
    const float middle = std::max(width - left - right - 2, 1.0f),
                view = std::max(height - plots - 1, 1.0f);
    return {.left = {0, 0, left, height},
            .view = {left + 1, 0, middle, view},
            .plots = {left + 1, view + 1, middle, plots},
            .images = {width - right, 0, right, height},
            .time_line = {}};
}

}  // namespace tessera
