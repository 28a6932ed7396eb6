// Synthetic scenes as a frame source: SOURCE `synthetic:NAME`, with exact poses and, on request,
// all ground truth.
#pragma once

#include <memory>
#include <string>

#include "core/config.h"
#include "io/frame_source.h"
#include "synth/builtin_scenes.h"
#include "synth/frame_faults.h"
#include "synth/frame_renderer.h"
#include "synth/sensor_model.h"

namespace tessera {

enum class UpAxis { kY, kZ };

struct SynthConfig {
    int frames = 0;  // 0: until the end of the scene's path or the trajectory file
    int seed = 1;    // of the noise; scenes and paths are fixed
    double fps = 30;
    PinholeCamera camera;
    std::string trajectory;  // TUM trajectory file; empty: the scene's own path
    // Start at the first pose of the scene's own path instead of the recorded one.
    bool trajectory_from_start = false;
    UpAxis model_up = UpAxis::kZ;  // of an .obj model, for its generated path
    double speed = 1;              // factor of the camera path
    CameraRig rig;
    SensorModel::Config sensor;
    FrameFaults::Config faults;

    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

class SyntheticSource : public ListedSource {
  public:
    SyntheticSource(std::string name, StagedScene staged, const SynthConfig& config);

    ReadResult Read(Frame& frame) override;
    // Also fills `truth`: the ideal view from which the frame was measured. Without faults.
    ReadResult ReadWithTruth(Frame& frame, RenderedView& truth);

    const Scene& scene() const { return *staged_.scene; }
    const SynthConfig& config() const { return config_; }

  private:
    ReadResult ReadFrame(Frame& frame, RenderedView& truth, bool with_patches);

    SynthConfig config_;
    StagedScene staged_;
    FrameRenderer renderer_;
    SensorModel sensor_;
    FrameFaults faults_;
    RenderedView view_;
};

// Time stamp of the first frame. File names made from the stamps sort as text.
inline constexpr double kFirstStamp_s = 1000.0;

// `name`: one of BuiltinSceneNames() or a path that ends in .obj, optionally preceded by
// "synthetic:". Errors name the scene or the file; for an unknown scene they list the known ones.
Result<std::unique_ptr<SyntheticSource>> OpenSynthetic(const std::string& name,
                                                       const SynthConfig& config);
// The same, as a generic frame source.
Result<std::unique_ptr<FrameSource>> OpenSyntheticScene(const std::string& name,
                                                        const SynthConfig& config);

}  // namespace tessera
