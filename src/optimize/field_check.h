// The last word on a loop: does the new frame fit the surface around the old keyframe, and the
// other way round? A small field is fused from the stored frames of each side and the other side is
// tracked in it, by the same tracker as any frame. The whole map would not do: where the camera has
// come back with drift it already holds both surfaces.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "mapping/integrator.h"
#include "optimize/frame_store.h"
#include "optimize/loop_config.h"
#include "tracking/residual_model.h"
#include "tracking/sdf_tracker.h"

namespace tessera {

// How the small fields are made and tracked in: as the map itself.
struct FieldSettings {
    PinholeCamera camera;
    BlockMap::Config map;
    Integrator::Config fusion;
    PreparedFrame::Config preparation;
    SdfTracker::Config tracker;
    ResidualModel::Config photometric;
    TrackJudge::Config judge;
};

// A stored frame beside a keyframe.
struct NearFrame {
    const StoredFrame* stored = nullptr;
    Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
};

// A frame that is to be placed beside an old keyframe.
struct FreshFrame {
    const PreparedFrame& prepared;
    FrameMotion motion;                    // while it was taken
    Eigen::Isometry3d T_old_new_features;  // where the features put it
    // Where it is thought to be; nothing of a lost camera.
    std::optional<Eigen::Isometry3d> T_old_new_expected;
};

struct FieldVerdict {
    bool accepted = false;
    // Where it was expected the frame fits about as well: tracking against the map has closed this
    // loop by itself.
    bool closed_before = false;
    // Of each side's depth, the share that lies on the other's surface: the smaller one.
    double explained = 0;
    Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();
    std::string reason;  // in words, unless accepted
};

// Owner thread only.
class FieldCheck {
  public:
    FieldCheck(const FieldSettings& settings, const LoopConfig& config);

    // `old_frames`: the old keyframe's own first, then others near it.
    FieldVerdict Check(std::span<const NearFrame> old_frames, const FreshFrame& fresh,
                       FrameStore& store);

  private:
    void FuseOld(std::span<const NearFrame> frames, FrameStore& store);
    bool Load(const StoredFrame& stored, FrameStore& store);  // false: it is damaged
    TrackResult Track(const PreparedFrame& frame, const FrameMotion& motion,
                      const Eigen::Isometry3d& T_field_camera);
    double ShareThatFits(const PreparedFrame& frame, const Eigen::Isometry3d& T_field_camera) const;
    std::string Fault(const TrackResult& track) const;

    FieldSettings settings_;
    LoopConfig config_;
    BlockMap map_;
    Integrator integrator_;
    ResidualModel model_;
    SdfTracker tracker_;
    Frame frame_;
    PreparedFrame prepared_;
};

}  // namespace tessera
