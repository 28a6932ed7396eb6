// Estimates a camera from views of a board: focal lengths, principal point, lens distortion, and
// the unit of its depth.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/status.h"
#include "run/calibration_board.h"

namespace tessera {

struct CalibrationResult {
    CameraCalibration calibration;  // with depth_scale as corrected, if depth showed it
    double fx_sigma_px = 0, fy_sigma_px = 0, cx_sigma_px = 0, cy_sigma_px = 0;
    double rms_px = 0;  // of the corners
    int views = 0;      // used
    // True distance over measured depth, and its standard deviation; nullopt: too little depth on
    // the board.
    std::optional<double> depth_factor;
    double depth_factor_sigma = 0;
};

// Owner thread only.
class CameraCalibrator {
  public:
    static constexpr int kLeastViews = 10, kEnoughViews = 40;

    explicit CameraCalibrator(const CalibrationBoard& board) : board_(board) {}

    // Takes a frame whose lens distortion was not corrected. Keeps it if it shows at least eight
    // corners, somewhere else than the views before. Returns whether it was kept.
    bool Add(const Frame& frame);

    int views() const { return static_cast<int>(views_.size()); }
    // Share of the image, in cells of a fifth of its width, in which corners were seen.
    double coverage() const;
    bool enough() const;

    // `depth_units_per_m`: of the frames' source.
    Result<CalibrationResult> Solve(double depth_units_per_m) const;

  private:
    struct DepthSample {
        Eigen::Vector2d pixel;
        double z_m;
    };
    struct View {
        BoardView seen;
        std::vector<DepthSample> depth;  // within the board
    };
    static std::vector<DepthSample> DepthWithin(const BoardView& seen, const DepthImage& depth_m);
    struct Poses;
    void FindDepthFactor(const Poses& poses, CalibrationResult& result) const;

    CalibrationBoard board_;
    int width_ = 0, height_ = 0;
    std::vector<View> views_;
};

}  // namespace tessera
