#include "system/camera_search.h"

#include <utility>

namespace tessera {

CameraSearch::Step CameraSearch::AfterTracking(TrackedFrame& tracked, bool may_ask) {
    using Verdict = LostCamera::Verdict;
    if (tracked.report.first) {  // a new world, or a new part of the scan
        place_.Close();
        found_at_.reset();
    }
    const bool by_appearance = camera_.relocalised();
    const Verdict verdict = camera_.Judge(tracked);
    Step step;
    if (verdict == Verdict::kLost) {
        T_doubted_.reset();
        step.lost = true;
        if (may_ask && tracked.prepared.valid_depth_pixels > 0) step.question = Question::kWhere;
        return step;
    }
    if (by_appearance && verdict == Verdict::kFoundAgain) step.note = Arrive(tracked);
    const Eigen::Isometry3d& T_map_camera = tracked.report.track.T_world_camera;
    // While a place is checked, a camera in doubt is looked for only there.
    if (verdict == Verdict::kDoubtful && !place_.open()) {
        if (!may_ask) return step;
        T_doubted_ = T_map_camera;
        step.question = Question::kWhere;
        return step;
    }
    if (!place_.open() || !tracked.report.tracked()) return step;
    tracked.to_fuse = false;
    if (!may_ask || !place_.Due(T_map_camera)) return step;
    place_.Remember(tracked.prepared, T_map_camera, tracked.report.track.degenerate);
    step.question = Question::kSecondView;
    return step;
}

void CameraSearch::TellWhereFound(TrackedFrame& tracked) {
    tracked.found_at.reset();
    if (tracked.report.tracked()) tracked.found_at = std::exchange(found_at_, std::nullopt);
}

bool CameraSearch::Confirms(const FoundCamera& found, const TrackedFrame& tracked) {
    const TrackResult& track = tracked.report.track;
    const bool there =
        track.status == TrackStatus::kGood && SamePlace(found.T_map_camera, track.T_world_camera);
    if (there) camera_.Confirm();
    return there;
}

const char* CameraSearch::Land(const FoundCamera& found, TrackedFrame& tracked) {
    const char* note = Arrive(tracked);
    camera_.BackOnTrack(tracked.report.stamp_s);
    found_at_ = found.keyframe;
    return note;
}

// Tracking confirms the place where the camera was found by appearance. If the camera cannot have
// got there from where it was, it may be another place that looks the same: a second view decides.
const char* CameraSearch::Arrive(TrackedFrame& tracked) {
    const StampedPose here{tracked.report.stamp_s, tracked.report.track.T_world_camera};
    const bool reached = camera_.CanReach(here);
    camera_.SetLastGood(here);
    if (!place_.open() && reached) return "";
    const bool confirmed = place_.Begin(tracked.prepared, here.T_world_camera, reached);
    tracked.to_fuse &= confirmed;
    return confirmed ? kPlaceConfirmed : kPlaceUnconfirmed;
}

std::optional<Eigen::Isometry3d> CameraSearch::TakeWhere(const std::optional<FoundCamera>& found,
                                                         double stamp_s) {
    if (!found) return std::nullopt;
    if (!camera_.lost()) {
        if (!T_doubted_) return std::nullopt;
        if (SamePlace(*T_doubted_, found->T_map_camera)) {
            camera_.Confirm();
            return std::nullopt;
        }
        camera_.Doubt();
    }
    camera_.SetRelocalised(stamp_s);
    found_at_ = found->keyframe;
    return found->T_map_camera;
}

bool CameraSearch::TakeSecondView(const std::optional<FoundCamera>& found, const char*& note) {
    if (!place_.Answer(found)) {
        camera_.Lose();
        note = kPlaceRefuted;
        return false;
    }
    if (!place_.open()) {
        found_at_ = found->keyframe;
        note = kPlaceConfirmed;
    }
    return true;
}

}  // namespace tessera
