// How far a recording's colour images lie off its depth images: two cameras that were brought into
// register by a wrong calibration, or not at all. Where a near surface ends in depth, colour has
// an edge, too; the shift under which the edges of many frames meet best is the answer. Texture
// and shadows of the depth camera lie on both sides of such edges and cancel out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "optimize/edge_view.h"

namespace tessera {

// In pixels of the depth image; positive: colour lies too far right, or too low.
struct ColourShift {
    double x_px = 0, y_px = 0;
    // Standard deviations, from how the estimate changes when eighths of the recording are left
    // out.
    double sigma_x_px = 0, sigma_y_px = 0;
    int width_px = 0;   // of the image
    int frames = 0;     // that were looked at
    bool known = true;  // false: the registration was a guess
    bool used = false;  // it was corrected

    // True if the images contradict the registration by more than such an estimate can be wrong.
    bool shown() const;
};

// "colour lies 21.3 +- 0.5 px right of and 12.1 +- 0.4 px above where depth puts it".
std::string ColourShiftText(const ColourShift& shift);

// Owner thread only. Stores 27 kB per frame.
class ColourShiftEstimator {
  public:
    // All frames have one size. Ignores empty views.
    void Add(const EdgeView& view);

    // Nothing if there are too few edges, if they meet nowhere better than elsewhere, or only at
    // the end of the search, a sixteenth of the image's width in each direction.
    std::optional<ColourShift> Estimate() const;

  private:
    static constexpr int kRadius = 20, kSide = 2 * kRadius + 1;  // of the search, in steps
    static constexpr std::size_t kDirections = EdgeView::kAhead.size();
    // For each direction in which a surface ends, and for each shift: the sum of the colour edges'
    // strength over the depth edges.
    struct Evidence {
        std::array<std::array<float, kSide * kSide>, kDirections> strength{};
        std::array<std::int64_t, kDirections> edges{};
        void Add(const Evidence& other);
    };
    struct Peak {
        double x = 0, y = 0;  // steps
    };
    static std::optional<Peak> Best(const Evidence& evidence);

    int step_px_ = 1, width_px_ = 0;
    std::vector<Evidence> frames_;
};

}  // namespace tessera
