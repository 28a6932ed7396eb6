#include "optimize/scan_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/se3.h"

namespace tessera {

ScanGraph::ScanGraph(const LoopConfig& config, const PinholeCamera& camera)
    : config_(config),
      keyframes_(camera, config.max_overlap, config.max_features),
      overlaps_(camera) {}

void ScanGraph::Resume(Memory memory) {
    keyframes_.Resume(std::move(memory.keyframes));
    edges_ = std::move(memory.edges);
    passages_ = std::move(memory.passages);
    loops_ = memory.loops;
    corrected_ = memory.corrected;
    moved_ = true;
}

void ScanGraph::AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused) {
    const std::optional<int> id = NewestInPartOf(T_map_camera);
    if (!id) return;
    const Eigen::Isometry3d T_keyframe_map = keyframes_[*id].T_map_camera.inverse();
    passages_.push_back({stamp_s, *id, Normalised(T_keyframe_map * T_map_camera), fused});
}

void ScanGraph::Link(int from, int to, const Eigen::Isometry3d& T_map_to, bool doubtful) {
    const Keyframe &a = keyframes_[from], &b = keyframes_[to], &before = keyframes_[to - 1];
    // Drift of tracking against the map: a constant per keyframe plus a share of the distance.
    constexpr double kDoubtful = 10.0;  // factor where tracking may have jumped
    const double trust =
        (b.inlier_fraction < config_.min_fit ? 2.0 : 1.0) * (doubtful ? kDoubtful : 1.0);
    const double sigma_m = 0.002 + 0.01 * std::min(1.0, b.path_length_m - before.path_length_m),
                 sigma_rad = 0.002 + 0.01 * std::min(1.0, b.turned_rad - before.turned_rad);
    edges_.push_back({from, to, Normalised(a.T_map_camera.inverse() * T_map_to),
                      RootInformation(trust * sigma_rad, trust * sigma_m), false});
}

void ScanGraph::AddLoop(int from, int to, const Eigen::Isometry3d& T_from_to) {
    edges_.push_back(LoopEdge(from, to, T_from_to));
    ++loops_;
}

std::vector<StampedPose> ScanGraph::Path() const {
    std::vector<StampedPose> path;
    for (const PathPose& p : passages_)
        if (!LeftOut(p.keyframe))
            path.push_back({p.stamp_s, Normalised(keyframes_[p.keyframe].T_world_camera *
                                                  p.T_keyframe_camera)});
    return path;
}

std::vector<Eigen::Isometry3d> ScanGraph::Poses() const {
    std::vector<Eigen::Isometry3d> poses;
    for (const Keyframe& keyframe : keyframes_.all()) poses.push_back(keyframe.T_world_camera);
    return poses;
}

std::vector<Eigen::Isometry3d> ScanGraph::MapPoses() const {
    std::vector<Eigen::Isometry3d> poses;
    for (const Keyframe& keyframe : keyframes_.all()) poses.push_back(keyframe.T_map_camera);
    return poses;
}

void ScanGraph::SetPoses(const std::vector<Eigen::Isometry3d>& T_world_keyframe) {
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_world_camera = T_world_keyframe[static_cast<std::size_t>(i)];
    moved_ = true;
}

void ScanGraph::SetMapPoses(const std::vector<Eigen::Isometry3d>& T_map_keyframe) {
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_map_camera = T_map_keyframe[static_cast<std::size_t>(i)];
}

double ScanGraph::Displacement_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const {
    double farthest = 0;
    for (int i = 0; i < keyframes_.size(); ++i) {
        const Eigen::Isometry3d &map = T_map_keyframe[static_cast<std::size_t>(i)],
                                &graph = keyframes_[i].T_world_camera;
        farthest = std::max(farthest, (map.translation() - graph.translation()).norm() +
                                          kReach_m * RotationAngle(map, graph));
    }
    return farthest;
}

std::optional<CovarianceFactors> ScanGraph::Factors() const {
    if (corrected_) return FindCovarianceFactors(keyframes_, edges_);
    const std::optional<double> aligned = AlignedFactor(keyframes_);
    return aligned ? std::optional<CovarianceFactors>({*aligned, 1}) : std::nullopt;
}

Status ScanGraph::Optimise() {
    std::vector<PoseEdge> edges = edges_;
    if (const std::optional<CovarianceFactors> factors = Factors()) {
        for (PoseEdge& edge : edges)
            if (!edge.loop) edge.root_information /= std::sqrt(factors->tracked);
        const std::vector<PoseEdge> overlaps = OverlapEdges(keyframes_, *factors);
        edges.insert(edges.end(), overlaps.begin(), overlaps.end());
    }
    std::vector<Eigen::Isometry3d> poses = Poses();
    if (Status solved = OptimisePoses(edges, poses); !solved.ok()) return solved;
    SetPoses(poses);
    return Status::Ok();
}

int ScanGraph::FindOverlaps() {
    constexpr int kMostNew = 60;
    int found = 0;
    for (int id = keyframes_.size() - 1; config_.overlaps && id > 0 && found < kMostNew; --id)
        found += overlaps_.Find(keyframes_, id, false);
    return found;
}

Status ScanGraph::OptimiseAgain() {
    if (Status solved = Optimise(); !solved.ok()) return solved;
    return FindOverlaps() > 0 ? Optimise() : Status::Ok();
}

std::optional<int> ScanGraph::NewestInPartOf(const Eigen::Isometry3d& T_map_camera) const {
    for (int id = keyframes_.size() - 1; id >= 0; --id)
        if (InOnePart(keyframes_[id].T_map_camera, T_map_camera)) return id;
    return std::nullopt;
}

int ScanGraph::KeyframesInPartOf(const Eigen::Isometry3d& T_map_camera) const {
    return static_cast<int>(std::ranges::count_if(keyframes_.all(), [&](const Keyframe& keyframe) {
        return InOnePart(keyframe.T_map_camera, T_map_camera);
    }));
}

Status ScanGraph::Join(std::span<const int> parts, int b, const JointPose& joint) {
    for (int id = 0; id < keyframes_.size(); ++id)
        if (parts[static_cast<std::size_t>(id)] == b)
            keyframes_[id].T_world_camera = Normalised(joint.T_a_b * keyframes_[id].T_world_camera);
    for (const CommonPlace& place : joint.places)
        edges_.push_back(LoopEdge(place.in_a, place.in_b, place.T_in_a_in_b));
    ++loops_;
    corrected_ = moved_ = true;
    return OptimiseAgain();
}

void ScanGraph::LeaveShortPartOut() {
    if (keyframes_.empty()) return;
    const std::vector<int> parts = Parts();
    const auto here = [&parts](int id) {
        return parts[static_cast<std::size_t>(id)] == parts.back();
    };
    if (std::ranges::count_if(passages_, here, &PathPose::keyframe) > kShortPart) return;
    left_out_.resize(parts.size());
    for (int id = 0; id < keyframes_.size(); ++id)
        if (here(id)) left_out_[static_cast<std::size_t>(id)] = true;
}

std::string ScanGraph::KeepLargestPart() {
    const std::vector<int> parts = Parts();
    std::vector<int> fused(parts.size(), 0);  // by keyframe
    for (const PathPose& p : passages_) fused[static_cast<std::size_t>(p.keyframe)] += p.fused;
    left_out_ = OutsideTheLargest(parts, fused);
    if (left_out_.empty()) return {};
    const auto kept = std::ranges::find(left_out_, false) - left_out_.begin();
    if (kept != 0) {
        const Eigen::Isometry3d T_first_world =
            keyframes_[static_cast<int>(kept)].T_world_camera.inverse();
        for (int id = 0; id < keyframes_.size(); ++id)
            keyframes_[id].T_world_camera =
                Normalised(T_first_world * keyframes_[id].T_world_camera);
    }
    corrected_ = true;
    const auto frames =
        std::ranges::count_if(passages_, [this](const PathPose& p) { return LeftOut(p.keyframe); });
    const auto others = std::set<int>(parts.begin(), parts.end()).size() - 1;
    return fmt::format("{} frames are left out, as nothing joins {} with the rest of the scan",
                       frames, others == 1 ? "their part" : fmt::format("their {} parts", others));
}

}  // namespace tessera
