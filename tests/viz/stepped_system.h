// A system behind a viewer link that a test steps by hand: the real pipeline and mesher, run on the
// test's thread. It stores every command and setting.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/frame_source.h"
#include "mapping/mesher.h"
#include "mapping/ray_caster.h"
#include "render/geometry_builder.h"
#include "system/pipeline.h"
#include "system/viewer_link.h"

namespace tessera::testing_support {

// Label colours of the left half of the world (x < 0) and of the rest.
inline constexpr Rgb8 kLeftLabel{240, 20, 30}, kNoLabel{150, 150, 150};

class SteppedSystem {
  public:
    SteppedSystem(ViewerLink& link, std::unique_ptr<FrameSource> source,
                  const PipelineConfig& config);

    // Handles what came over the link and then, unless paused, processes one frame. Returns false
    // at the end of the source or after kStop.
    bool Step();

    const PinholeCamera& camera() const { return source_->info().camera; }
    std::int64_t frames() const { return counts_.frames; }
    const std::vector<ViewerCommand>& commands() const { return commands_; }
    const std::vector<ViewerSettings>& settings() const { return settings_; }

  private:
    void Obey();
    void ProcessFrame(std::shared_ptr<const Frame> frame, double decode_ms);
    void SendImages(const std::shared_ptr<const Frame>& frame, const FrameReport& report);
    void SendMesh();
    void StartAnew();

    ViewerLink& link_;
    PipelineConfig config_;
    std::unique_ptr<FrameSource> source_;
    std::unique_ptr<Pipeline> pipeline_;
    std::unique_ptr<Mesher> mesher_;
    GeometryBuilder builder_;
    RayCaster caster_;
    bool clear_ = true, paused_ = false, one_step_ = false, stopped_ = false;
    RunCounts counts_;
    std::optional<Eigen::Isometry3d> T_map_truth_;
    ViewerSettings wanted_;
    std::vector<ViewerCommand> commands_;
    std::vector<ViewerSettings> settings_;
};

}  // namespace tessera::testing_support
