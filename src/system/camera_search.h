// Finds a camera that is lost, or whose pose is in doubt: decides after each frame whether its pose
// is trusted and what is to be looked for among the keyframes, and takes the answers. In lockstep
// an answer comes within the same frame, live some frames later.
#pragma once

#include <optional>

#include "system/lost_camera.h"
#include "system/place_check.h"

namespace tessera {

// Owner thread only: the thread that tracks.
class CameraSearch {
  public:
    enum class Question {
        kNone,
        kWhere,       // where in the map the camera is
        kSecondView,  // whether it is where it is tracked; after it was found by appearance
    };
    struct Step {
        bool lost = false;  // do not trust the pose, whatever its status
        Question question = Question::kNone;
        const char* note = "";  // for the user
    };

    // `max_gap_s`: see LostCamera.
    CameraSearch(const LoopConfig& config, double max_gap_s, const PinholeCamera& camera)
        : camera_(config, max_gap_s), place_(camera) {}

    // See LostCamera.
    void Resume(double last_seen_s, bool lost) { camera_.Resume(last_seen_s, lost); }
    // The map was moved.
    void Move(const Eigen::Isometry3d& T_new_old) {
        camera_.Move(T_new_old);
        place_.Move(T_new_old);
    }

    // Call once for each frame, after tracking. Nothing is fused while a place is checked.
    // `may_ask`: no earlier question waits for its answer.
    Step AfterTracking(TrackedFrame& tracked, bool may_ask);
    // Call when the frame's pose is final: sets its `found_at`.
    void TellWhereFound(TrackedFrame& tracked);

    // ---- The answer to kWhere in the same frame.

    // True if a camera in doubt, which is tracked well, was found where it is tracked: it stays
    // there.
    bool Confirms(const FoundCamera& found, const TrackedFrame& tracked);
    // The camera was found and tracked there. Returns a note for the user.
    const char* Land(const FoundCamera& found, TrackedFrame& tracked);

    // ---- The answer to kWhere later, before the frame of this time is tracked.

    // Returns the pose to track it from, if the camera is lost or was tracked elsewhere. It lands
    // when tracking confirms the pose.
    std::optional<Eigen::Isometry3d> TakeWhere(const std::optional<FoundCamera>& found,
                                               double stamp_s);

    // ---- The answer to kSecondView.

    // Returns false if the camera is elsewhere, and lost. Changes `note` if there is one for the
    // user.
    bool TakeSecondView(const std::optional<FoundCamera>& found, const char*& note);

  private:
    const char* Arrive(TrackedFrame& tracked);

    LostCamera camera_;
    PlaceCheck place_;
    std::optional<int> found_at_;  // for the next frame that is tracked: see TrackedFrame
    // Where a camera in doubt was tracked when it was asked for.
    std::optional<Eigen::Isometry3d> T_doubted_;
};

}  // namespace tessera
