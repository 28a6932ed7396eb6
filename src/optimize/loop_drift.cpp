// Drift that direct alignment shows, and the solution of LoopCloser's pose graph.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optimize/loop_closer.h"

namespace tessera {

// Corrects the path if direct alignment shows that tracking is off.
std::string LoopCloser::SeekDrift(const Keyframe& fresh) {
    const std::optional<double> factor = AlignedFactor(keyframes_);
    if (!factor) return {};
    // Two alignments with older keyframes must say so: one may be wrong, and neighbours in time
    // show no drift.
    constexpr int kRecent = 3, kWitnesses = 2;
    // The map would not show less.
    const double least_m = settings_.map.voxel_size_m;
    int witnesses = 0;
    const Keyframe* old = nullptr;
    Drift drift;
    for (int id = fresh.id; id > std::max(0, fresh.id - kRecent); --id)
        for (const Overlap& overlap : keyframes_[id].overlaps) {
            if (!IsOlder(overlap, id) || !Contradicts(overlap, *factor)) continue;
            const Drift implied = DriftOf(keyframes_[overlap.with], keyframes_[id],
                                          overlap.T_with_this_aligned, config_.max_drift);
            if (!implied.conceivable || implied.off_m < least_m) continue;
            ++witnesses;
            if (implied.off_m <= drift.off_m) continue;
            old = &keyframes_[overlap.with];
            drift = implied;
        }
    if (old == nullptr || witnesses < kWitnesses) return {};
    const bool first = !corrected_;
    if (first) {
        const std::vector<Eigen::Isometry3d> before = GraphPoses();
        if (Status solved = Optimise(); !solved.ok()) return solved.message();
        if (MaxDisplacement_m(before) < least_m) {
            SetGraphPoses(before);  // nothing that matters: tracking is more accurate
            return {};
        }
        corrected_ = true;
        ++loops_;
    }
    if (Status solved = OptimiseAgain(); !solved.ok()) return solved.message();
    return first ? ClosedText(*old, drift) : std::string();
}

std::string LoopCloser::ClosedText(const Keyframe& old, const Drift& drift) const {
    return fmt::format("loop closed with frame {}: {:.1f} cm and {:.1f} degrees off",
                       old.frame_index, 100 * drift.off_m, drift.off_rad * 57.29578);
}

std::vector<Eigen::Isometry3d> LoopCloser::GraphPoses() const {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < keyframes_.size(); ++i) poses.push_back(keyframes_[i].T_world_camera);
    return poses;
}

void LoopCloser::SetGraphPoses(const std::vector<Eigen::Isometry3d>& T_world_keyframe) {
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_world_camera = T_world_keyframe[static_cast<std::size_t>(i)];
    moved_ = true;
}

// Tracking's usual drift is believed until a loop was worth correcting with it.
std::optional<CovarianceFactors> LoopCloser::Factors() const {
    if (corrected_) return FindCovarianceFactors(keyframes_, edges_);
    const std::optional<double> aligned = AlignedFactor(keyframes_);
    return aligned ? std::optional<CovarianceFactors>({*aligned, 1}) : std::nullopt;
}

// On error the keyframes do not move.
Status LoopCloser::Optimise() {
    std::vector<PoseEdge> edges = edges_;
    if (const std::optional<CovarianceFactors> factors = Factors()) {
        for (PoseEdge& edge : edges)
            if (!edge.loop) edge.root_information /= std::sqrt(factors->tracked);
        const std::vector<PoseEdge> overlaps = OverlapEdges(keyframes_, *factors);
        edges.insert(edges.end(), overlaps.begin(), overlaps.end());
    }
    std::vector<Eigen::Isometry3d> poses = GraphPoses();
    if (const auto report = OptimisePoses(edges, poses); !report.ok()) return report.status();
    SetGraphPoses(poses);
    return Status::Ok();
}

// Looks for overlaps that the corrected poses show for the first time, newest keyframes first.
// Returns their number.
int LoopCloser::FindOverlaps() {
    constexpr int kMostNew = 60;
    int found = 0;
    for (int id = keyframes_.size() - 1; config_.overlaps && id > 0 && found < kMostNew; --id)
        found += overlaps_.Find(keyframes_, id, false);
    return found;
}

// Once a loop was corrected, with the overlaps and the covariances that it shows.
Status LoopCloser::OptimiseAgain() {
    if (Status solved = Optimise(); !solved.ok()) return solved;
    return FindOverlaps() > 0 ? Optimise() : Status::Ok();
}

}  // namespace tessera
