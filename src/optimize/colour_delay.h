// How much later than its time stamp says a recording's colour was taken, seen from depth. While
// the camera turns, colour's edges lie beside those of depth, by their speed in the image times the
// delay. The delay under which the edges of many frames meet best is the answer. A rolling shutter
// adds to it in proportion to the row, if depth is not read in the same way. Where colour's
// read-out time is known, depth is taken as read in the same time or all at once, whichever fits
// better.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"
#include "optimize/edge_view.h"
#include "tracking/image_aligner.h"

namespace tessera {

struct ColourDelay {
    double delay_s = 0;    // between the middle rows, beyond the time stamps
    double readout_s = 0;  // colour's read-out time minus depth's
    // Standard deviation, from how the estimate changes when eighths of the recording are left out.
    double delay_sigma_s = 0;
    bool depth_rolls = false;  // depth is read row by row, as colour is; false if that is not known
    bool used = false;

    // What is certain of it: two standard deviations less. Too much is worse than too little, of
    // which tracking learns the rest.
    double certain_s() const;
    // True if that is worth correcting.
    bool shown() const;
};

// "colour was taken 20.4 +- 1.2 ms later than its time stamps say".
std::string ColourDelayText(const ColourDelay& delay);

// Owner thread only. Stores about 0.2 MB per frame at 640 x 480.
class ColourDelayEstimator {
  public:
    explicit ColourDelayEstimator(const PinholeCamera& camera);

    // In time order, about ten per second. `edges`: of the frame, ignored if empty.
    void Add(const Frame& frame, const EdgeView& edges);

    // `colour_readout_s`: nothing if it is not known; both values are then searched for.
    // Works in parallel; the result does not depend on the number of threads. Nothing if fewer than
    // 24 views lie between two others, if there are too few edges in either direction, or if they
    // meet best at the end of the search: 40 ms, for both values.
    std::optional<ColourDelay> Estimate(std::optional<double> colour_readout_s) const;

  private:
    struct View {
        double stamp_s = 0;
        double stamped_delay_s = 0;        // of colour
        Vector6d step = Vector6d::Zero();  // twist from the last view
        int step_px = 1;
        std::array<std::vector<EdgeView::End>, EdgeView::kAhead.size()> ends;
        Image<std::uint8_t> across, down;  // EdgeView's, smoothed, in 255ths
    };
    struct Evidence;

    void AddView(const View& view, const Vector6d& velocity, Evidence& evidence) const;
    // Body twists per second, of views whose neighbours are near in time.
    std::vector<std::optional<Vector6d>> Velocities() const;

    PinholeCamera camera_;
    ImageAligner aligner_;
    PreparedFrame prepared_;
    Eigen::Isometry3d T_last_current_ = Eigen::Isometry3d::Identity();
    std::vector<View> views_;
};

}  // namespace tessera
