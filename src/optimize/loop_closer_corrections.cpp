// Corrected maps of LoopCloser, during a run and at its end.
#include <limits>
#include <utility>

#include "core/se3.h"
#include "optimize/loop_closer.h"

namespace tessera {
namespace {

constexpr double kAnyDifference_m = -1;  // a tolerance

// Makes one correction of two: the map is the later one's, the camera moves as in both.
void Append(std::optional<LoopCloser::Correction> next,
            std::optional<LoopCloser::Correction>& last) {
    if (!next) return;
    if (last) next->T_new_old = Normalised(next->T_new_old * last->T_new_old);
    last = std::move(next);
}

}  // namespace

std::optional<LoopCloser::Correction> LoopCloser::Step(int frames) {
    if (!seeking_) return std::nullopt;
    graph_.ClearMoved();
    // What is left waits for the end.
    if (!corrector_.Begin(corrector_.OneSurface_m())) return std::nullopt;
    return StepCorrection(frames);
}

std::optional<LoopCloser::Correction> LoopCloser::StepCorrection(int frames) {
    Keyframes& keyframes = graph_.keyframes();
    // What was fused since the map was copied lies beside `newest`, and is moved as the camera.
    const int newest = link_.value_or(keyframes.last().id), here = seen_at_.value_or(newest);
    if (!MoveAlike(here, newest)) DiscardCopy();
    if (!corrector_.busy()) return std::nullopt;
    const std::unique_ptr<MapRebuild> made = corrector_.Step(frames);
    if (!made) return std::nullopt;
    const std::vector<Eigen::Isometry3d>& T_new_keyframe = made->T_world_keyframe();
    Correction correction;
    correction.map = made->TakeMap();
    correction.labels = made->TakeLabels();
    correction.pager = made->TakePager();
    correction.moved = made->has_copy();
    correction.T_new_old = Normalised(T_new_keyframe[static_cast<std::size_t>(here)] *
                                      keyframes[here].T_map_camera.inverse());
    graph_.SetMapPoses(T_new_keyframe);
    graph_.MarkMoved();
    keyframes.Move(correction.T_new_old);
    jumps_.Move(correction.T_new_old);
    swapped_ = true;
    return correction;
}

// Whether the map that is being made moves keyframe b, and what it sees, as keyframe a, to within
// what a map can show.
bool LoopCloser::MoveAlike(int a, int b) const {
    const Eigen::Isometry3d& T_map_b = graph_.keyframes()[b].T_map_camera;
    const auto moved_as = [&](int id) {
        return Eigen::Isometry3d(corrector_.T_new_keyframe()[static_cast<std::size_t>(id)] *
                                 graph_.keyframes()[id].T_map_camera.inverse() * T_map_b);
    };
    const Eigen::Isometry3d by_a = moved_as(a), by_b = moved_as(b);
    return (by_a.translation() - by_b.translation()).norm() +
               ScanGraph::kReach_m * RotationAngle(by_a, by_b) <
           settings_.map.voxel_size_m / 2;
}

// All of what was begun. Nothing if it cannot be made.
std::optional<LoopCloser::Correction> LoopCloser::MakeAll(const std::function<void()>& free_map) {
    if (free_map && corrector_.FusesAll()) free_map();
    while (corrector_.busy())
        if (std::optional<Correction> made = StepCorrection(std::numeric_limits<int>::max()))
            return made;
    return std::nullopt;
}

// A map of all stored frames, whatever the one in use is like.
std::optional<LoopCloser::Correction> LoopCloser::FuseAll(const std::function<void()>& free_map) {
    return corrector_.Begin(kAnyDifference_m) ? MakeAll(free_map) : std::nullopt;
}

// Returns true if the scan shows another calibration, with which the map is to be made again.
bool LoopCloser::Calibrate(std::string& note) {
    if (!config_.refine_calibration || graph_.keyframes().empty()) return false;
    const FieldSettings given = settings_;
    const Result<CalibrationReport> found = CalibrateScan(graph_, store_, settings_);
    if (found.ok()) calibration_ = found.value();
    note = found.ok() ? CalibrationText(given.camera, given.preparation.disparity_offset_per_m,
                                        found.value())
                      : found.status().message();
    return found.ok() && found.value().shown;
}

// Returns true if the map in use has parts of the scan that nothing joins with the rest.
bool LoopCloser::LeavePartsOut(std::string& note) {
    const std::string left_out = graph_.KeepLargestPart();
    if (left_out.empty()) return false;
    note += (note.empty() ? "" : "; ") + left_out;
    return true;
}

std::optional<LoopCloser::Correction> LoopCloser::Finish(std::string& note, const BlockMap* in_use,
                                                         const std::function<void()>& free_map) {
    store_.StoreLatest();
    if (seeking_ && graph_.corrected())
        static_cast<void>(graph_.OptimiseAgain());  // else as it was
    const bool calibrated = Calibrate(note);
    const bool parts_left_out = LeavePartsOut(note);
    if (!graph_.corrected()) return std::nullopt;
    if (!calibrated && !parts_left_out) return CatchUp(in_use, free_map);
    corrector_.Discard();
    // Parts can be taken out of the map in use. Another calibration changes all of it.
    if (calibrated || !in_use || corrector_.labels() || !corrector_.MayMove(*in_use))
        return FuseAll(free_map);
    corrector_.BeginParts(*in_use);
    std::optional<Correction> last = MakeAll();
    Append(CatchUp(last->map.get()), last);
    return last;
}

// The map of the graph as it is now. The map in use is moved, if it is given and can be; else what
// was begun is made, or all is fused again. Nothing if the map in use is right.
std::optional<LoopCloser::Correction> LoopCloser::CatchUp(const BlockMap* in_use,
                                                          const std::function<void()>& free_map) {
    const double tolerance_m = settings_.map.voxel_size_m / 2;
    if (in_use && (graph_.PartsMove() || !corrector_.MayMove(*in_use))) in_use = nullptr;
    // To move the map in use takes less time than what is left.
    if (in_use)
        corrector_.Discard();
    else
        corrector_.DiscardOutdated(tolerance_m);
    std::optional<Correction> last;
    while (corrector_.Begin(corrector_.doubtful() ? kAnyDifference_m : tolerance_m,
                            std::exchange(in_use, nullptr)))
        Append(MakeAll(free_map), last);
    return last;
}

Result<LoopCloser::Correction> LoopCloser::MakeAgain() {
    constexpr int kMostRounds = 100;
    graph_.MarkCorrected();
    for (int round = 0; round < kMostRounds; ++round) {
        const bool last_round = graph_.FindOverlaps() == 0;
        if (Status solved = graph_.Optimise(); !solved.ok()) return solved;
        if (last_round) break;
    }
    static_cast<void>(graph_.KeepLargestPart());
    std::optional<Correction> made = FuseAll();
    if (!made) return Status::Error(TakeError());
    return std::move(*made);
}

}  // namespace tessera
