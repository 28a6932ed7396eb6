#include "optimize/depth_distortion_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/quantile.h"
#include "core/se3.h"
#include "optimize/camera_view.h"
#include "optimize/depth_residuals.h"

namespace tessera {
namespace {

constexpr int kAcross = DistortionNodes::kColumns, kDown = DistortionNodes::kRows,
              kNodes = DistortionNodes::kCount;
constexpr int kEighths = 8;
constexpr int kFewestViewPairs = 8, kFewestPoints = 100;
// Standard deviations before anything is seen: of a node, of its second differences, and of the
// mean, in 1/m; of a pair's motion. Residuals of neighbours are correlated, so twenty count as one.
constexpr double kNodeBefore = 0.02, kBendBefore = 0.003, kMeanBefore = 1e-4;
constexpr double kTurnBefore_rad = 0.15, kShiftBefore_m = 0.15;
constexpr double kAsOne = 20;
constexpr double kCauchy = 2;                            // in deviations
constexpr double kGate = 10;                             // in deviations
constexpr double kFirstFactor = 3, kLeastFactor = 0.05;  // of kDepthNoise_per_m
constexpr double kWorstPair = 2;  // a pair's residuals beside the median pair's

class DistortionFit {
  public:
    DistortionFit(const std::vector<DepthView>& views, const PinholeCamera& camera,
                  std::vector<DepthPair> pairs)
        : views_(views),
          pairs_(std::move(pairs)),
          camera_(Averaged(camera, views.front().reduction)) {
        before_ = Eigen::MatrixXd::Identity(kNodes, kNodes) / (kNodeBefore * kNodeBefore);
        const Eigen::VectorXd share = ShareOfNodes();
        before_ += share * share.transpose() / (kMeanBefore * kMeanBefore);
        const auto bend = [&](int a, int b, int c) {
            const int at[3] = {a, b, c};
            constexpr double kFactor[3] = {1, -2, 1};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    before_(at[i], at[j]) += kFactor[i] * kFactor[j] / (kBendBefore * kBendBefore);
        };
        for (int row = 0; row < kDown; ++row)
            for (int column = 0; column < kAcross; ++column) {
                const int n = row * kAcross + column;
                if (column > 0 && column < kAcross - 1) bend(n - 1, n, n + 1);
                if (row > 0 && row < kDown - 1) bend(n - kAcross, n, n + kAcross);
            }
    }

    // One step of Gauss-Newton. If `motions_only`, the nodes stay.
    void Iterate(bool motions_only) {
        hessian_ = before_;
        gradient_ = before_ * nodes_.per_m;
        ClearParts();
        std::vector<double> all, scales;
        std::vector<std::size_t> measured;
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (!pairs_[i].usable) continue;
            FindDepthResiduals(View(pairs_[i].from), View(pairs_[i].to), camera_,
                               pairs_[i].T_to_from, nodes_, kGate * factor_, residuals_);
            pairs_[i].usable = residuals_.size() >= kFewestPoints;
            if (!pairs_[i].usable) continue;
            std::vector<double> sizes;
            for (const DepthResidual& r : residuals_) sizes.push_back(std::abs(r.value));
            scales.push_back(Median(sizes));
            measured.push_back(i);
            for (std::size_t k = 0; k < sizes.size(); k += 8) all.push_back(sizes[k]);
            Add(i);
        }
        if (measured.empty()) return;
        Eigen::VectorXd step = Eigen::VectorXd::Zero(kNodes);
        if (!motions_only) step = -hessian_.ldlt().solve(gradient_);
        for (const std::size_t i : measured) {
            const Motion& m = motions_[i];
            const Vector6d twist = -m.inverse * (m.gradient + m.to_nodes.transpose() * step);
            pairs_[i].T_to_from = Se3Exp(twist) * pairs_[i].T_to_from;
            motions_[i].moved += twist;
        }
        nodes_.per_m += step;
        constexpr double kToDeviation = 1.4826;  // from the median of normal residuals
        factor_ = std::max(kToDeviation * Median(all), kLeastFactor);
        const double worst = kWorstPair * Median(scales);
        for (std::size_t k = 0; k < measured.size(); ++k)
            pairs_[measured[k]].usable = scales[k] <= worst;
    }

    std::optional<DepthDistortionEstimate> Result() const {
        DepthDistortionEstimate estimate;
        estimate.pairs = static_cast<int>(
            std::count_if(pairs_.begin(), pairs_.end(), [](const auto& p) { return p.usable; }));
        if (estimate.pairs < kFewestViewPairs) return std::nullopt;
        estimate.found = {kAcross, kDown, {}};
        for (int i = 0; i < kNodes; ++i) {
            const auto error = static_cast<float>(nodes_.per_m(i));
            estimate.found.per_m.push_back(error);
            estimate.largest_per_m =
                std::max(estimate.largest_per_m, static_cast<double>(std::abs(error)));
        }
        estimate.noise_per_m = factor_ * kDepthNoise_per_m;
        estimate.rms_per_m = nodes_.per_m.norm() / std::sqrt(kNodes);
        const auto solver = hessian_.ldlt();
        double spread = 0;
        for (const Eigen::MatrixXd* parts : {&by_time_, &by_depth_}) {
            const double count = static_cast<double>(parts->cols());
            const Eigen::MatrixXd apart = parts->colwise() - parts->rowwise().mean();
            spread += count / (count - 1) * solver.solve(apart).squaredNorm();
        }
        estimate.sigma_per_m = std::sqrt(spread / kNodes);
        return estimate;
    }

  private:
    struct Motion {
        Eigen::Matrix<double, kNodes, 6> to_nodes;
        Matrix6d inverse;
        Vector6d gradient, moved = Vector6d::Zero();
    };

    void ClearParts() {
        by_time_ = Eigen::MatrixXd::Zero(kNodes, kEighths);
        by_depth_ = Eigen::MatrixXd::Zero(kNodes, 2);
        motions_.resize(pairs_.size());
    }

    // By how much of the mean depth all depths are wrong if a node is, in relation to the others.
    // The sum is 1.
    Eigen::VectorXd ShareOfNodes() const {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(kNodes);
        for (const DepthView& view : views_)
            for (int y = 0; y < view.inverse_depth.height(); y += 2)
                for (int x = 0; x < view.inverse_depth.width(); x += 2) {
                    if (view.inverse_depth(x, y) <= 0) continue;
                    const DistortionNodes::Place place = nodes_.At(x, y, camera_);
                    for (int i = 0; i < 4; ++i)
                        sum(place.nodes[i]) += place.share[i] / view.inverse_depth(x, y);
                }
        return sum / std::max(sum.sum(), 1e-9);
    }

    // Adds the pair's residuals, its own motion eliminated.
    void Add(std::size_t index) {
        Motion& m = motions_[index];
        m.to_nodes.setZero();
        Matrix6d own = Matrix6d::Zero();
        own.diagonal().head<3>().setConstant(1 / (kTurnBefore_rad * kTurnBefore_rad));
        own.diagonal().tail<3>().setConstant(1 / (kShiftBefore_m * kShiftBefore_m));
        m.gradient = own * m.moved;
        Vector6d own_near = Vector6d::Zero();
        Eigen::VectorXd near = Eigen::VectorXd::Zero(kNodes), all = Eigen::VectorXd::Zero(kNodes);
        std::vector<double> depths;
        for (const DepthResidual& r : residuals_) depths.push_back(r.z_m);
        const double middle_m = Median(depths);
        for (const DepthResidual& r : residuals_) {
            const double far = r.value / (kCauchy * factor_);
            const double weight = 1 / (factor_ * factor_ * (1 + far * far) * kAsOne);
            own.noalias() += weight * r.to_motion * r.to_motion.transpose();
            const Vector6d motion_part = weight * r.value * r.to_motion;
            m.gradient += motion_part;
            const bool is_near = r.z_m < middle_m;
            if (is_near) own_near += motion_part;
            for (int i = 0; i < 8; ++i) {
                const double w = weight * r.to_nodes[i];
                for (int j = 0; j < 8; ++j) hessian_(r.nodes[i], r.nodes[j]) += w * r.to_nodes[j];
                m.to_nodes.row(r.nodes[i]) += w * r.to_motion.transpose();
                all(r.nodes[i]) += w * r.value;
                if (is_near) near(r.nodes[i]) += w * r.value;
            }
        }
        m.inverse = own.inverse();
        const Eigen::Matrix<double, kNodes, 6> reduced = m.to_nodes * m.inverse;
        hessian_.noalias() -= reduced * m.to_nodes.transpose();
        const Eigen::VectorXd whole = all - reduced * m.gradient,
                              of_near = near - reduced * own_near;
        gradient_ += whole;
        by_time_.col(static_cast<Eigen::Index>(index * kEighths / pairs_.size())) += whole;
        by_depth_.col(0) += of_near;
        by_depth_.col(1) += whole - of_near;
    }

    const DepthView& View(int i) const { return views_[static_cast<std::size_t>(i)]; }

    const std::vector<DepthView>& views_;
    std::vector<DepthPair> pairs_;
    const PinholeCamera camera_;
    double factor_ = kFirstFactor;
    DistortionNodes nodes_;
    Eigen::VectorXd gradient_ = Eigen::VectorXd::Zero(kNodes);
    Eigen::MatrixXd before_, hessian_;
    Eigen::MatrixXd by_time_, by_depth_;    // gradients of parts, a column each
    std::vector<DepthResidual> residuals_;  // of the pair at hand
    std::vector<Motion> motions_;
};

}  // namespace

bool DepthDistortionEstimate::shown() const {
    // In standard deviations. What is left after the correction is then a ninth of the error's
    // square.
    constexpr double kSure = 3;
    // Of the noise, which is taken to be at least this. Noisy cameras seem to have errors of the
    // size of their noise, and exact ones of half a millimetre at 1 m.
    constexpr double kAboveNoise = 2, kLeastNoise_per_m = 0.0005;
    return rms_per_m >
           std::max(kSure * sigma_per_m, kAboveNoise * std::max(noise_per_m, kLeastNoise_per_m));
}

std::string DepthDistortionText(const DepthDistortionEstimate& estimate) {
    return fmt::format(
        "depth is up to {:.0f} mm wrong at 1 m, depending on the place in the image ({:.1f} +- "
        "{:.1f} mm rms)",
        1000 * estimate.largest_per_m, 1000 * estimate.rms_per_m, 1000 * estimate.sigma_per_m);
}

std::optional<DepthDistortionEstimate> FitDepthDistortion(const std::vector<DepthView>& views,
                                                          const PinholeCamera& camera,
                                                          std::vector<DepthPair> pairs) {
    if (pairs.empty()) return std::nullopt;
    DistortionFit fit(views, camera, std::move(pairs));
    for (int i = 0; i < 3; ++i) fit.Iterate(true);
    for (int i = 0; i < 6; ++i) fit.Iterate(false);
    return fit.Result();
}

}  // namespace tessera
