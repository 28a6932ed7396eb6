// Constraints from every overlap: keyframes that see the same surface are aligned directly, and
// what the alignment says is weighed against how they were tracked.
#pragma once

#include <list>
#include <map>
#include <utility>
#include <vector>

#include "optimize/covariance_factors.h"
#include "optimize/dense_view.h"
#include "optimize/keyframes.h"
#include "optimize/pose_graph.h"
#include "optimize/view_alignment.h"

namespace tessera {

// Finds the overlaps of keyframes. Owner thread only.
class OverlapFinder {
  public:
    explicit OverlapFinder(const PinholeCamera& camera) : camera_(camera) {}

    // Aligns keyframe `id` with earlier ones that see the same surface according to the pose graph,
    // and adds the overlaps to it that it does not have yet: with the last few keyframes, and with
    // the older ones that share most. `tracked`: T_map_camera of both are from tracking; else this
    // is not the first time, and pairs that failed are not tried again while their relative pose is
    // the same to within a centimetre or two. Returns the number of new overlaps.
    int Find(Keyframes& keyframes, int id, bool tracked);
    // Aligns keyframe `id` with an earlier one, starting from T_with_this. Returns true if it has
    // the overlap now.
    bool Align(Keyframes& keyframes, int id, int with, const Eigen::Isometry3d& T_with_this,
               bool tracked);

    // Aligns any view with a keyframe, starting from T_keyframe_view. Does not converge if the
    // keyframe has no reduced view.
    ViewAlignment AlignView(const Keyframe& keyframe, const DenseView& view,
                            const Eigen::Isometry3d& T_keyframe_view) {
        return keyframe.reduced.empty() ? ViewAlignment()
                                        : AlignViews(ViewOf(keyframe), view, T_keyframe_view);
    }
    // Of a keyframe with a reduced view. Valid until 15 other keyframes have been viewed.
    const DenseView& ViewOf(const Keyframe& keyframe);

  private:
    struct Cached {
        int id = 0;
        DenseView view;
    };

    // In which cell of a grid a relative pose is.
    using Cell = Eigen::Matrix<int, 6, 1>;

    std::vector<int> Candidates(const Keyframes& keyframes, int id) const;
    bool AlignOnce(Keyframes& keyframes, int id, int with, const Eigen::Isometry3d& T_with_this);

    PinholeCamera camera_;
    std::map<std::pair<int, int>, Cell> failed_;  // by keyframes: where AlignOnce failed last
    std::list<Cached> cache_;                     // most recently used first
};

// True if the other keyframe is not one of the last few before `id`.
bool IsOlder(const Overlap& overlap, int id);

// How tracking differs from the alignment: a right increment of T_with_this_aligned. For an overlap
// that was tracked.
Vector6d TrackedOff(const Overlap& overlap);

// The square of it in standard deviations of the alignment.
double SquaredDifference(const Overlap& overlap);

// True if the alignment and tracking exclude each other. `factor`: CovarianceFactors::aligned.
bool Contradicts(const Overlap& overlap, double factor);

// Edges for the pose graph. Where alignment contradicts tracking (two surfaces lie side by side in
// the map, or tracking has slid from one to the other) the alignment counts, elsewhere the mean of
// both, by their covariances.
std::vector<PoseEdge> OverlapEdges(const Keyframes& keyframes, const CovarianceFactors& factors);

}  // namespace tessera
