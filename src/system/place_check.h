// A camera that was relocalised may be in another room of the same kind. It is tracked, but nothing
// is fused until a second view, which shares less than half with the first, is found where the
// camera was tracked to; or, if it was lost meanwhile, where it can have got to.
#pragma once

#include <optional>

#include "optimize/keyframes.h"
#include "optimize/place_finder.h"

namespace tessera {

// Whether two poses of a camera are one place, found twice: within 10 cm and 6 degrees.
inline bool SamePlace(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    constexpr double kSame = 0.1;  // metres and radians
    return (a.translation() - b.translation()).norm() <= kSame && RotationAngle(a, b) <= kSame;
}

// Owner thread only: the thread that tracks.
class PlaceCheck {
  public:
    explicit PlaceCheck(const PinholeCamera& camera) : camera_(camera) {}

    // The camera was relocalised and tracked there. `reached`: it can have got there from the place
    // that is being checked. Another view of that is then its second: returns true, and it is
    // confirmed.
    bool Begin(const PreparedFrame& frame, const Eigen::Isometry3d& T_map_camera, bool reached) {
        const bool confirmed = reached && Due(T_map_camera);
        failed_ = 0;
        open_ = !confirmed;
        Remember(frame, T_map_camera);
        return confirmed;
    }
    // The camera is elsewhere.
    void Close() { open_ = false; }
    // Nothing is fused.
    bool open() const { return open_; }
    // The camera sees enough that is new to ask where this is.
    bool Due(const Eigen::Isometry3d& T_map_camera) const {
        return open_ && ViewOverlap(seen_m_, camera_.Every(kKeyframeReduction),
                                    T_map_camera.inverse() * T_map_seen_) < kNewView;
    }
    // This frame is now looked for among the keyframes. A view that leaves a motion open, as of a
    // bare wall, may be found nowhere, and may have drifted: it can confirm the place but not
    // refute it.
    void Remember(const PreparedFrame& frame, const Eigen::Isometry3d& T_map_camera,
                  bool degenerate = false) {
        refutes_ = !degenerate;
        seen_m_ = ReducedDepth(frame.depth_m, kKeyframeReduction);
        T_map_seen_ = T_map_camera;
    }
    // Where the frame remembered last was found. Returns false if the place has been refuted: too
    // many views were found elsewhere or nowhere.
    [[nodiscard]] bool Answer(const std::optional<FoundCamera>& found) {
        const bool there = found && SamePlace(found->T_map_camera, T_map_seen_);
        if (!there && refutes_) ++failed_;
        open_ = !there && failed_ < kMostFailed;
        return there || open_;
    }
    // The map was moved.
    void Move(const Eigen::Isometry3d& T_new_old) { T_map_seen_ = T_new_old * T_map_seen_; }

  private:
    static constexpr double kNewView = 0.5;
    static constexpr int kMostFailed = 3;

    PinholeCamera camera_;
    bool open_ = false, refutes_ = true;
    int failed_ = 0;
    DepthImage seen_m_;  // of the last view that was looked for, reduced
    Eigen::Isometry3d T_map_seen_ = Eigen::Isometry3d::Identity();
};

inline constexpr const char *kPlaceUnconfirmed =
                                "nothing is fused until a second view confirms the place",
                            *kPlaceConfirmed = "a second view confirms the place",
                            *kPlaceRefuted = "other views show that this is another place";

}  // namespace tessera
