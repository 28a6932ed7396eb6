#include "optimize/overlaps.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "optimize/scan_parts.h"

namespace tessera {
namespace {

constexpr int kNear = 4;    // keyframes back: never seen at two different times
constexpr int kOlder = 8;   // at most this many older ones
constexpr int kTried = 16;  // of older ones, as some do not see the same
constexpr double kLeastShared = 0.3, kLeastFit = 0.5;
// Tracking against the map, between two keyframes that see the same surface.
constexpr double kTracked_m = 0.002, kTracked_rad = 0.002;
// What the alignments' covariance leaves out at least.
constexpr double kFloor_m = 0.001, kFloor_rad = 0.0005;

// The 99.9th percentile of a chi-squared variable with six degrees of freedom.
constexpr double kSurely = 22.5;

Eigen::Isometry3d Between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
    return Normalised(from.inverse() * to);
}

// A quick test that spares most pairs the exact one.
bool MayOverlap(const Eigen::Isometry3d& T_a_b) {
    constexpr double kFar_m = 5, kTurned_rad = 1.3;
    return T_a_b.translation().norm() < kFar_m &&
           RotationAngle(T_a_b, Eigen::Isometry3d::Identity()) < kTurned_rad;
}

double Shared(const Keyframe& a, const Keyframe& b) {
    const Eigen::Isometry3d T_a_b = Between(a.T_world_camera, b.T_world_camera);
    if (!MayOverlap(T_a_b)) return 0;
    const double one_way = ViewOverlap(b.depth_m, b.view, T_a_b);
    if (one_way < kLeastShared) return 0;
    return std::min(one_way, ViewOverlap(a.depth_m, a.view, T_a_b.inverse()));
}

// The information of a measurement with independent errors of these standard deviations besides its
// own.
Matrix6d WithErrors(const Matrix6d& information, double sigma_rad, double sigma_m) {
    const Matrix6d root = RootInformation(sigma_rad, sigma_m);
    const Matrix6d covariance = (root.transpose() * root).inverse();
    const Matrix6d result =
        (Matrix6d::Identity() + information * covariance).partialPivLu().solve(information);
    return 0.5 * (result + result.transpose());
}

Matrix6d Root(const Matrix6d& information) {
    // A view may leave motions open: a tiny prior keeps the factor defined.
    const Matrix6d regular = information + 1e-3 * Matrix6d::Identity();
    return Eigen::LLT<Matrix6d>(regular).matrixU();
}

PoseEdge EdgeOf(const Overlap& overlap, int to, const CovarianceFactors& factors) {
    PoseEdge edge{overlap.with, to, overlap.T_with_this_aligned, Matrix6d::Identity(), true};
    const Matrix6d aligned = overlap.information / factors.aligned;
    edge.root_information = Root(aligned);
    if (!overlap.T_with_this_tracked || Contradicts(overlap, factors.aligned)) return edge;
    const double more = std::sqrt(factors.tracked);
    const Matrix6d root = RootInformation(more * kTracked_rad, more * kTracked_m);
    const Matrix6d both = aligned + root.transpose() * root;
    const Vector6d off =
        Se3Log(overlap.T_with_this_tracked->inverse() * overlap.T_with_this_aligned);
    edge.T_from_to =
        Normalised(*overlap.T_with_this_tracked * Se3Exp(both.ldlt().solve(aligned * off)));
    // Between neighbours the edges of consecutive tracking have tracking's part already.
    if (IsOlder(overlap, to)) edge.root_information = Root(both);
    return edge;
}

}  // namespace

int OverlapFinder::Find(Keyframes& keyframes, int id, bool tracked) {
    const auto older = [id](int with) { return id - with > kNear; };
    int left = kOlder - static_cast<int>(
                            std::ranges::count_if(keyframes[id].overlaps, older, &Overlap::with));
    int found = 0;
    for (const int with : Candidates(keyframes, id)) {
        if (older(with) && left <= 0) break;
        const Eigen::Isometry3d T_with_this =
            Between(keyframes[with].T_world_camera, keyframes[id].T_world_camera);
        if (!(tracked ? Align(keyframes, id, with, T_with_this, true)
                      : AlignOnce(keyframes, id, with, T_with_this)))
            continue;
        ++found;
        left -= older(with);
    }
    return found;
}

// Every solution moves the keyframes a little, and most pairs that failed would fail again. So
// alignment starts from the nearest pose on a grid, which is near enough for it: what failed from
// there fails from there again, and is left out. A resumed scan, which has forgotten it, tries it
// in vain and goes on the same.
bool OverlapFinder::AlignOnce(Keyframes& keyframes, int id, int with,
                              const Eigen::Isometry3d& T_with_this) {
    constexpr double kGrid = 0.02;  // metres and radians
    const Vector6d start = (Se3Log(T_with_this) / kGrid).array().round();
    const Cell cell = start.cast<int>();
    const auto failed = failed_.find({with, id});
    if (failed != failed_.end() && failed->second == cell) return false;
    if (Align(keyframes, id, with, Se3Exp(kGrid * start), false)) return true;
    failed_[{with, id}] = cell;
    return false;
}

bool OverlapFinder::Align(Keyframes& keyframes, int id, int with,
                          const Eigen::Isometry3d& T_with_this, bool tracked) {
    const Keyframe& old = keyframes[with];
    Keyframe& fresh = keyframes[id];
    if (old.reduced.empty() || fresh.reduced.empty()) return false;
    // The newest view first: it stays in the cache.
    const DenseView& b = ViewOf(fresh);
    const ViewAlignment aligned = AlignViews(ViewOf(old), b, T_with_this);
    if (!aligned.converged || aligned.overlap < 0.7 * kLeastShared || aligned.fit < kLeastFit)
        return false;
    const Matrix6d information =
        WithErrors(aligned.information, std::hypot(kFloor_rad, old.skew_rad, fresh.skew_rad),
                   std::hypot(kFloor_m, old.skew_m, fresh.skew_m));
    Overlap overlap{with, aligned.T_a_b, information, std::nullopt};
    // Two parts that were just joined are still apart in the map.
    if (tracked && InOnePart(old.T_map_camera, fresh.T_map_camera))
        overlap.T_with_this_tracked = Between(old.T_map_camera, fresh.T_map_camera);
    fresh.overlaps.push_back(overlap);
    return true;
}

// The last few that share enough, then older ones, those that share most first. Of neighbours in
// time only one: the other would add little, or not see the same either.
std::vector<int> OverlapFinder::Candidates(const Keyframes& keyframes, int id) const {
    const Keyframe& fresh = keyframes[id];
    if (fresh.reduced.empty()) return {};
    std::vector<int> chosen;
    std::vector<std::pair<double, int>> older;
    std::vector<int> known;
    for (const Overlap& overlap : fresh.overlaps) known.push_back(overlap.with);
    for (int with = id - 1; with >= 0; --with) {
        if (keyframes[with].reduced.empty() || std::ranges::count(known, with) > 0) continue;
        const double shared = Shared(keyframes[with], fresh);
        if (shared < kLeastShared) continue;
        if (id - with <= kNear)
            chosen.push_back(with);
        else
            older.emplace_back(shared, with);
    }
    std::ranges::sort(older, std::greater{});
    int count =
        static_cast<int>(std::ranges::count_if(known, [&](int with) { return id - with > kNear; }));
    for (const auto& [shared, with] : older) {
        if (count >= kTried) break;
        if (std::ranges::any_of(known, [at = with](int other) { return std::abs(other - at) < 2; }))
            continue;
        known.push_back(with);
        chosen.push_back(with);
        ++count;
    }
    return chosen;
}

const DenseView& OverlapFinder::ViewOf(const Keyframe& keyframe) {
    constexpr std::size_t kMost = 16;
    const auto cached = std::ranges::find(cache_, keyframe.id, &Cached::id);
    if (cached != cache_.end()) {
        cache_.splice(cache_.begin(), cache_, cached);
    } else {
        cache_.push_front({keyframe.id, MakeDenseView(keyframe.reduced, camera_)});
        if (cache_.size() > kMost) cache_.pop_back();
    }
    return cache_.front().view;
}

double SquaredDifference(const Overlap& overlap) {
    const Vector6d off = TrackedOff(overlap);
    return off.dot(overlap.information * off);
}

bool IsOlder(const Overlap& overlap, int id) { return id - overlap.with > kNear; }

Vector6d TrackedOff(const Overlap& overlap) {
    return Se3Log(overlap.T_with_this_aligned.inverse() * *overlap.T_with_this_tracked);
}

bool Contradicts(const Overlap& overlap, double factor) {
    return overlap.T_with_this_tracked && SquaredDifference(overlap) > kSurely * factor;
}

std::vector<PoseEdge> OverlapEdges(const Keyframes& keyframes, const CovarianceFactors& factors) {
    std::vector<PoseEdge> edges;
    for (int id = 0; id < keyframes.size(); ++id)
        for (const Overlap& overlap : keyframes[id].overlaps)
            edges.push_back(EdgeOf(overlap, id, factors));
    return edges;
}

}  // namespace tessera
