#include "optimize/camera_fit.h"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr int kCount = CameraUnknowns::kCount, kOwn = CameraPairSums::kOwn;
constexpr int kTimes = 8;
constexpr int kLeastPairs = 6, kLeastPoints = 100;
constexpr double kLeastSeen = 0.25;  // share of a view's points that the other view must see
// Pairs whose residual scale exceeds the median by this factor are excluded: their motion was not
// found.
constexpr double kWorstScale = 1.8;
constexpr double kLongestStep_rad = 0.1;  // per iteration
// Prior standard deviations of the camera: log focal length, centre in image widths, read-out time
// in seconds, vignetting. Residuals of neighbouring pixels are correlated, so a hundred count as
// one.
constexpr double kBefore[kCount] = {0.2, 0.01, 0.01, 0.02, 0.3};
constexpr double kTogether = 100;

using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;

// Contribution of one pair, its own unknowns eliminated (Schur complement).
struct Share {
    Eigen::Matrix<double, kOwn, kOwn> own_inverse;
    Eigen::Matrix<double, kCount, kOwn> to_own;
    Matrix hessian = Matrix::Zero();
    std::array<Vector, CameraView::kRegions> gradient;
    Vector whole = Vector::Zero();

    explicit Share(const CameraPairSums& sums) {
        Eigen::Matrix<double, kOwn, kOwn> own = sums.hessian.topLeftCorner<kOwn, kOwn>();
        own.diagonal() *= 1 + 1e-6;
        own.diagonal().array() += 1e-3;
        own_inverse = own.inverse();
        to_own = sums.hessian.bottomLeftCorner<kCount, kOwn>() * own_inverse;
        hessian = sums.hessian.bottomRightCorner<kCount, kCount>() -
                  to_own * sums.hessian.topRightCorner<kOwn, kCount>();
        for (std::size_t i = 0; i < gradient.size(); ++i) {
            gradient[i] = sums.gradient[i].tail<kCount>() - to_own * sums.gradient[i].head<kOwn>();
            whole += gradient[i];
        }
    }
};

class Fit {
  public:
    Fit(const std::vector<CameraView>& views, const PinholeCamera& given,
        std::vector<CameraPair> pairs)
        : views_(views), given_(given), pairs_(std::move(pairs)) {
        for (int i = 0; i < kCount; ++i) before_(i, i) = kTogether / (kBefore[i] * kBefore[i]);
    }

    // Iterates on one level. If `camera_free` is false, the camera is held fixed. Returns the mean
    // robust error per point.
    double Refine(int level, int iterations, bool camera_free) {
        double misfit = 0;
        for (int i = 0; i < iterations; ++i) {
            misfit = Linearise(level);
            Vector step = Vector::Zero();
            if (camera_free)
                step = -(hessian_ + before_).ldlt().solve(gradient_ + before_ * State());
            MovePairs(step);
            unknowns_.Add(step);
            if (camera_free && i > 0 && std::abs(step(0)) < 1e-5 &&
                step.segment<2>(1).norm() < 1e-5)
                break;
        }
        return misfit;
    }

    // Excludes pairs whose motion was not found.
    void RejectOutlierPairs() {
        std::vector<double> scales;
        for (const CameraPair& pair : pairs_)
            if (pair.usable) scales.push_back(pair.scale);
        if (scales.empty()) return;
        const double worst = kWorstScale * Median(scales);
        for (CameraPair& pair : pairs_) pair.usable = pair.usable && pair.scale <= worst;
    }

    int usable() const {
        return static_cast<int>(std::count_if(pairs_.begin(), pairs_.end(),
                                              [](const CameraPair& pair) { return pair.usable; }));
    }
    const CameraUnknowns& unknowns() const { return unknowns_; }
    void Set(const CameraUnknowns& unknowns) { unknowns_ = unknowns; }
    // Keeps the residual scales fixed, so that misfits are comparable.
    void HoldScales() { hold_scales_ = true; }

    // At the last linearisation.
    Vector Deviations() const {
        const Matrix inverse = (hessian_ + before_).inverse();
        Matrix spread = Matrix::Zero();
        const auto add = [&](const std::vector<Vector>& parts) {
            const double few =
                static_cast<double>(parts.size()) / static_cast<double>(parts.size() - 1);
            for (const Vector& part : parts) spread += few * part * part.transpose();
        };
        using V = CameraView;
        add(ByRegion(V::kRings, V::kQuarters * V::kDepths * V::kDirections));
        add(ByRegion(V::kQuarters, V::kDepths * V::kDirections));
        add(ByRegion(V::kDepths, V::kDirections));
        add(ByRegion(V::kDirections, 1));
        add(ByTime());
        return (inverse * spread * inverse).diagonal().cwiseSqrt();
    }

  private:
    Vector State() const {
        return {unknowns_.log_focal, unknowns_.centre_x, unknowns_.centre_y, unknowns_.readout_s,
                unknowns_.vignetting};
    }

    double Linearise(int level) {
        sums_.resize(pairs_.size());
        tbb::parallel_for(std::size_t{0}, pairs_.size(), [&](std::size_t i) {
            const CameraPair& pair = pairs_[i];
            if (pair.usable)
                sums_[i] = SumPair(View(pair.from), View(pair.to), level, given_, unknowns_, pair);
        });
        shares_.clear();
        hessian_.setZero();
        gradient_.setZero();
        double error = 0;
        int used = 0;
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            pairs_[i].usable = pairs_[i].usable && sums_[i].used >= kLeastPoints &&
                               sums_[i].used >= kLeastSeen * sums_[i].points;
            if (!pairs_[i].usable) continue;
            shares_.emplace_back(sums_[i]);
            hessian_ += shares_.back().hessian;
            gradient_ += shares_.back().whole;
            error += sums_[i].error;
            used += sums_[i].used;
        }
        return used > 0 ? error / used : 0;
    }

    void MovePairs(const Vector& step) {
        std::size_t share = 0;
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            CameraPair& pair = pairs_[i];
            if (!pair.usable) continue;
            const Share& s = shares_[share++];
            Eigen::Matrix<double, kOwn, 1> gradient = s.to_own.transpose() * step;
            Eigen::Matrix<double, kOwn, 1> own = Eigen::Matrix<double, kOwn, 1>::Zero();
            for (const auto& part : sums_[i].gradient) own += part.head<kOwn>();
            gradient += s.own_inverse * own;
            Vector6d twist = -gradient.head<6>();
            if (const double turn = twist.head<3>().norm(); turn > kLongestStep_rad)
                twist *= kLongestStep_rad / turn;
            pair.T_to_from = Se3Exp(twist) * pair.T_to_from;
            pair.gain = std::clamp(pair.gain - gradient(6), -0.5, 0.5);
            pair.offset -= gradient(7);
            if (!hold_scales_) pair.scale = sums_[i].scale;
        }
    }

    // Region index = (outer, group, inner), inner fastest.
    std::vector<Vector> ByRegion(int groups, int inner) const {
        std::vector<Vector> parts(static_cast<std::size_t>(groups), Vector::Zero());
        for (const Share& share : shares_)
            for (int i = 0; i < CameraView::kRegions; ++i)
                parts[static_cast<std::size_t>(i / inner % groups)] +=
                    share.gradient[static_cast<std::size_t>(i)];
        return parts;
    }

    std::vector<Vector> ByTime() const {
        std::vector<Vector> parts(kTimes, Vector::Zero());
        std::size_t share = 0;
        const int count = static_cast<int>(views_.size());
        for (const CameraPair& pair : pairs_)
            if (pair.usable)
                parts[static_cast<std::size_t>(std::min(pair.from, pair.to) * kTimes / count)] +=
                    shares_[share++].whole;
        return parts;
    }

    const CameraView& View(int i) const { return views_[static_cast<std::size_t>(i)]; }

    const std::vector<CameraView>& views_;
    const PinholeCamera given_;
    std::vector<CameraPair> pairs_;
    CameraUnknowns unknowns_;
    std::vector<CameraPairSums> sums_;
    std::vector<Share> shares_;  // one per usable pair, in order
    Matrix hessian_ = Matrix::Zero(), before_ = Matrix::Zero();
    Vector gradient_ = Vector::Zero();
    bool hold_scales_ = false;
};

}  // namespace

std::optional<CameraEstimate> FitCamera(const std::vector<CameraView>& views,
                                        const PinholeCamera& given, std::vector<CameraPair> pairs) {
    Fit fit(views, given, std::move(pairs));
    fit.Refine(0, 6, false);
    fit.Refine(0, 8, true);
    fit.Refine(1, 8, true);
    fit.RejectOutlierPairs();
    fit.Refine(2, 5, true);
    fit.RejectOutlierPairs();
    fit.HoldScales();
    CameraEstimate estimate;
    estimate.misfit_found = fit.Refine(2, 8, true);
    estimate.pairs = fit.usable();
    if (estimate.pairs < kLeastPairs) return std::nullopt;
    CameraUnknowns unknowns = fit.unknowns();
    const Vector deviations = fit.Deviations();
    estimate.given = given;
    estimate.found = unknowns.Applied(given);
    estimate.focal_sigma_px = deviations(0) * estimate.found.fx;
    estimate.centre_x_sigma_px = deviations(1) * given.width;
    estimate.centre_y_sigma_px = deviations(2) * given.width;
    estimate.readout_s = unknowns.readout_s;
    estimate.readout_sigma_s = deviations(3);
    estimate.vignetting = unknowns.vignetting;
    estimate.vignetting_sigma = deviations(4);
    // Misfit of the given camera, with its own motions but the estimated read-out time and
    // vignetting.
    unknowns.log_focal = unknowns.centre_x = unknowns.centre_y = 0;
    fit.Set(unknowns);
    estimate.misfit_given = fit.Refine(2, 4, false);
    return estimate;
}

}  // namespace tessera
