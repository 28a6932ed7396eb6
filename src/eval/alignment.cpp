#include "eval/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace tessera {
namespace {

constexpr std::size_t kMinPairs = 3;

// The poses of both trajectories in one list, ordered by time. The closest reference and estimate
// are always adjacent in it, even after others are removed: anything between them would be closer
// to one of the two.
class TimeLine {
  public:
    TimeLine(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate) {
        entries_.reserve(reference.size() + estimate.size() + 2);
        entries_.push_back({});  // a sentinel at either end
        for (std::size_t r = 0, e = 0; r < reference.size() || e < estimate.size();) {
            const bool take_reference =
                e == estimate.size() ||
                (r < reference.size() && reference[r].stamp_s <= estimate[e].stamp_s);
            const StampedPose& pose = take_reference ? reference[r] : estimate[e];
            entries_.push_back({pose.stamp_s, take_reference ? Kind::kReference : Kind::kEstimate,
                                take_reference ? r++ : e++});
        }
        entries_.push_back({});
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            entries_[i].before = i == 0 ? 0 : i - 1;
            entries_[i].after = i + 1;
        }
    }

    std::vector<PosePair> Associate(double max_difference_s) {
        for (std::size_t i = 1; i + 1 < entries_.size(); ++i) Offer(i, max_difference_s);
        std::vector<PosePair> pairs;
        while (!candidates_.empty()) {
            const auto [difference_s, reference_index, left, right] = candidates_.top();
            candidates_.pop();
            Entry& a = entries_[left];
            Entry& b = entries_[right];
            if (a.taken || b.taken) continue;
            a.taken = b.taken = true;
            entries_[a.before].after = b.after;
            entries_[b.after].before = a.before;
            const bool a_is_reference = a.kind == Kind::kReference;
            pairs.push_back(a_is_reference ? PosePair{a.index, b.index}
                                           : PosePair{b.index, a.index});
            Offer(a.before, max_difference_s);
        }
        std::sort(pairs.begin(), pairs.end(),
                  [](const PosePair& x, const PosePair& y) { return x.reference < y.reference; });
        return pairs;
    }

  private:
    enum class Kind { kEnd, kReference, kEstimate };
    struct Entry {
        double stamp_s = 0;
        Kind kind = Kind::kEnd;
        std::size_t index = 0;  // in its trajectory
        std::size_t before = 0, after = 0;
        bool taken = false;
    };
    // Difference, reference index, left and right entry. The smallest comes first.
    using Candidate = std::tuple<double, std::size_t, std::size_t, std::size_t>;

    // Adds entry i and the one after it as a candidate if they are of different kinds and close.
    void Offer(std::size_t i, double max_difference_s) {
        const Entry& a = entries_[i];
        const Entry& b = entries_[a.after];
        if (a.kind == Kind::kEnd || b.kind == Kind::kEnd || a.kind == b.kind) return;
        const double difference_s = std::abs(b.stamp_s - a.stamp_s);
        if (!(difference_s < max_difference_s)) return;
        const std::size_t reference = a.kind == Kind::kReference ? a.index : b.index;
        candidates_.emplace(difference_s, reference, i, a.after);
    }

    std::vector<Entry> entries_;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

Status TooFewPairs(const std::vector<StampedPose>& reference,
                   const std::vector<StampedPose>& estimate, std::size_t pairs,
                   double max_difference_s) {
    if (reference.empty()) return Status::Error("the reference trajectory is empty");
    if (estimate.empty()) return Status::Error("the estimated trajectory is empty");
    if (pairs > 0)
        return Status::Error(fmt::format(
            "only {} of the estimate's {} poses lie within {} s of a reference pose; an alignment "
            "needs at least {}",
            pairs, estimate.size(), max_difference_s, kMinPairs));
    return Status::Error(fmt::format(
        "no pose of the estimate ({:.3f} to {:.3f} s) lies within {} s of one of the reference "
        "({:.3f} to {:.3f} s); are they from the same sequence?",
        estimate.front().stamp_s, estimate.back().stamp_s, max_difference_s,
        reference.front().stamp_s, reference.back().stamp_s));
}

// The rotation is undetermined if the positions spread over less than 1 mm, or 100 times less
// across than along their main direction.
std::string WarnIfDegenerate(const Eigen::Matrix3Xd& positions) {
    const Eigen::Matrix3Xd centred = positions.colwise() - positions.rowwise().mean();
    const Eigen::Matrix3d covariance =
        centred * centred.transpose() / static_cast<double>(positions.cols());
    const Eigen::Vector3d spread =
        covariance.jacobiSvd().singularValues().cwiseSqrt();  // metres, largest first
    if (spread(0) < 1e-3)
        return "the camera hardly moved: the alignment's rotation is not determined";
    if (spread(1) < 0.01 * spread(0))
        return "the camera moved along a line: the alignment's rotation about it is not determined";
    return {};
}

}  // namespace

std::vector<PosePair> AssociateByTime(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      double max_difference_s) {
    return TimeLine(reference, estimate).Associate(max_difference_s);
}

Result<Alignment> AlignTrajectories(const std::vector<StampedPose>& reference,
                                    const std::vector<StampedPose>& estimate,
                                    double max_difference_s) {
    Alignment result;
    result.pairs = AssociateByTime(reference, estimate, max_difference_s);
    if (result.pairs.size() < kMinPairs)
        return TooFewPairs(reference, estimate, result.pairs.size(), max_difference_s);
    const auto count = static_cast<Eigen::Index>(result.pairs.size());
    Eigen::Matrix3Xd p_reference(3, count), p_estimate(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const PosePair& pair = result.pairs[static_cast<std::size_t>(i)];
        p_reference.col(i) = reference[pair.reference].T_world_camera.translation();
        p_estimate.col(i) = estimate[pair.estimate].T_world_camera.translation();
    }
    result.T_reference_estimate.matrix() = Eigen::umeyama(p_estimate, p_reference, false);
    result.warning = WarnIfDegenerate(p_reference);
    return result;
}

}  // namespace tessera
