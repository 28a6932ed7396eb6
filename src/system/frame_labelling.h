// The labelling part of a frame's life where one thread does everything (lockstep, inspect). Live,
// a LabellingThread detects.
#pragma once

#include "system/labelling_stage.h"
#include "system/tracking_stage.h"
#include "system/viewer_settings.h"

namespace tessera {

// Owner thread only.
class FrameLabelling {
  public:
    // `open`: opens another detector during the run; empty if none can be chosen.
    FrameLabelling(const LabelConfig& config, const PinholeCamera& camera,
                   OpenDetectorFunction open = {})
        : config_(config), camera_(camera), open_(std::move(open)), stage_(config, camera) {}

    void Begin(Labelling labelling) {
        stage_ = LabellingStage(std::move(labelling.detector), std::move(labelling.classes),
                                config_, camera_);
    }
    // Continues a scan in which so many frames were fused with labelling on.
    void Resume(std::int64_t frames) { frames_ = frames; }

    // Detects in every stride-th fused frame, or `always`, and in every stride-th frame while none
    // is fused. If that lacks colour, in the next one that has it. Before the frame is tracked,
    // because people in it may have to be masked.
    void Detect(const Frame& frame, bool always, TrackingStage& tracking);
    // Call after the frame was fused: counts it, and returns its detections. Nothing if it was not
    // looked at.
    std::optional<LabelReport> TakeDetections();
    // What Detect found in the last frame, unless it was taken.
    const std::optional<LabelReport>& detected() const { return detected_; }
    std::int64_t frames() const { return frames_; }

    // Replaces the detector by the one that settings name, at each choice of one. Returns what came
    // of it.
    std::optional<DetectorChange> Choose(const ViewerSettings& settings);

    // Why the detector failed, once; else empty.
    std::string TakeFailure() { return std::exchange(failure_, {}); }
    // Once after another detector came into use; else without classes.
    DetectorChange TakeBegun() { return std::exchange(begun_, {}); }

  private:
    LabelConfig config_;
    PinholeCamera camera_;
    OpenDetectorFunction open_;
    LabellingStage stage_;
    std::optional<LabelReport> detected_;
    std::string failure_;
    int choice_ = 0;  // ViewerSettings::detector_choice
    DetectorChange begun_;
    std::int64_t frames_ = 0;
    std::int64_t unfused_ = 0;  // frames since the last that was fused
    bool owed_ = false;         // a frame that was due lacked colour
    bool unused_ = false;       // the last one detected in was not fused
};

}  // namespace tessera
