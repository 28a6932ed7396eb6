// A frame's life: prepare, track, judge, fuse. No thread of its own; whoever drives it may step it frame by frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/frame.h"
#include "mapping/block_map.h"
#include "mapping/integrator.h"
#include "mapping/prepared_frame.h"
#include "system/motion_model.h"
#include "system/tracking_method.h"
#include "tracking/image_aligner.h"

namespace tessera {

// When a frame's images and rows were taken.
struct ShutterConfig {
    bool colour_delay = true;
    double depth_readout_s = 0;
    double colour_readout_s = 0;

    void Describe(ConfigParameters& parameters);
};

struct PipelineConfig {
    PreparedFrame::Config frame;
    BlockMap::Config map;
    Integrator::Config fusion;
    MotionModel::Config motion;
    ShutterConfig shutter;
    ImageAligner::Config prealign;
    TrackersConfig trackers;

    // Sections frame, mapping, tracking.
    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

// What became of one frame.
struct FrameReport {
    std::int64_t index = 0;
    double stamp_s = 0;
    TrackingMethod method = TrackingMethod::kSdf;
    TrackResult track;       // status good, with the given pose, when poses are given
    bool first = false;      // the frame that started the map
    bool fused = false;
    double valid_depth_fraction = 0;
    std::string warning;     // what a person should know of this frame, in words; mostly empty
    Integrator::Report fusion;
    double prepare_ms = 0, track_ms = 0;

    bool tracked() const { return track.status != TrackStatus::kLost; }
};

class Pipeline {
  public:
    Pipeline(const PipelineConfig& config, const PinholeCamera& camera);

    // Owner thread only. With a given pose the frame is fused there and not tracked. The world is the first fused
    // frame's camera unless its pose is given.
    FrameReport Process(const Frame& frame, const std::optional<Eigen::Isometry3d>& given = std::nullopt);

    // From the next frame on; pose, velocity, brightness and map stay.
    void Select(TrackingMethod method) { trackers_.Select(method); }

    // Off: frames are tracked, but the map stays as it is; but the first frame always starts it.
    void SetFusing(bool on) { fusing_ = on; }

    const BlockMap& map() const { return map_; }
    const Integrator& integrator() const { return integrator_; }

  private:
    TrackResult TrackFrame(const Frame& frame);
    FrameMotion ShutterOf(const Frame& frame) const;
    Integrator::View FusionView(const TrackResult& track) const;

    PipelineConfig config_;
    PinholeCamera camera_;
    BlockMap map_;
    Integrator integrator_;
    MotionModel motion_;
    ImageAligner aligner_;
    Trackers trackers_;
    PreparedFrame prepared_;
    bool fusing_ = true;
};

}  // namespace tessera
