// Final check of a loop: does the new frame fit the surface around the old keyframe, and vice
// versa? It fuses a small field from the stored frames of each side and tracks the other side in
// it, with the usual tracker. The full map would not do: where the camera came back with drift, it
// already contains both surfaces.
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

// Settings of the small fields and their tracking; the same as for the map.
struct FieldSettings {
    PinholeCamera camera;
    BlockMap::Config map;
    Integrator::Config fusion;
    PreparedFrame::Config preparation;
    SdfTracker::Config tracker;
    ResidualModel::Config photometric;
    TrackJudge::Config judge;
};

// A stored frame near a keyframe.
struct NearFrame {
    const StoredFrame* stored = nullptr;
    Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
};

// A frame to be aligned with an old keyframe.
struct FreshFrame {
    const PreparedFrame& prepared;
    FrameMotion motion;                    // while it was captured
    Eigen::Isometry3d T_old_new_features;  // pose according to the features
    // Current estimate of the pose; empty if the camera is lost.
    std::optional<Eigen::Isometry3d> T_old_new_expected;
};

struct FieldVerdict {
    bool accepted = false;
    // The frame fits about as well at its expected pose: tracking against the map has already
    // closed this loop.
    bool closed_before = false;
    // Share of the depth of one side that lies on the surface of the other; the smaller of the two.
    double explained = 0;
    Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();
};

// Owner thread only.
class FieldCheck {
  public:
    FieldCheck(const FieldSettings& settings, const LoopConfig& config);

    // `old_frames`: the frame of the old keyframe first, then others near it. Refuses if empty.
    FieldVerdict Check(std::span<const NearFrame> old_frames, const FreshFrame& fresh,
                       FrameStore& store);

  private:
    void FuseOld(std::span<const NearFrame> frames, FrameStore& store);
    bool Load(const StoredFrame& stored, FrameStore& store);  // false if damaged
    TrackResult Track(const PreparedFrame& frame, const FrameMotion& motion,
                      const Eigen::Isometry3d& T_field_camera);
    double InlierShare(const PreparedFrame& frame, const Eigen::Isometry3d& T_field_camera) const;
    bool Fits(const TrackResult& track) const;

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
