// Synthetic scenes as a frame source: SOURCE `synthetic:NAME`, with exact poses and, for who asks,
// all truth.
#pragma once

#include <memory>
#include <string>

#include "core/config.h"
#include "io/frame_source.h"
#include "synth/builtin_scenes.h"
#include "synth/frame_renderer.h"
#include "synth/sensor_model.h"

namespace tessera {

enum class UpAxis { kY, kZ };

struct SynthConfig {
    int frames = 0;  // 0: as long as the scene's motion (or the trajectory file) goes
    int seed = 1;    // of the noise; the scenes and motions themselves are fixed
    double fps = 30;
    PinholeCamera camera;
    std::string trajectory;  // TUM trajectory file; empty: the scene's own motion
    bool trajectory_from_start =
        false;  // begin at the scene's own first pose instead of the recorded one
    UpAxis model_up = UpAxis::kZ;  // of an .obj model, for its own motion
    double speed = 1;              // of the motion
    CameraRig rig;
    SensorModel::Config sensor;

    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

class SyntheticSource : public FrameSource {
  public:
    SyntheticSource(std::string name, StagedScene staged, const SynthConfig& config);

    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override;
    // Fills `truth` too: the ideal view that the frame was measured from.
    ReadResult ReadWithTruth(Frame& frame, RenderedView& truth);
    bool Seek(std::int64_t index) override;

    const Scene& scene() const { return *staged_.scene; }
    const SynthConfig& config() const { return config_; }

  private:
    ReadResult ReadFrame(Frame& frame, RenderedView& truth, bool with_patches);

    SynthConfig config_;
    StagedScene staged_;
    FrameRenderer renderer_;
    SensorModel sensor_;
    SourceInfo info_;
    RenderedView view_;
    std::int64_t next_ = 0;
};

// The first frame's time stamp: file names made from stamps sort as text.
inline constexpr double kFirstStamp_s = 1000.0;

// `name`: one of BuiltinSceneNames() or a path that ends in .obj, with or without "synthetic:"
// before it. Errors name the scene or file, and for an unknown scene the known ones.
Result<std::unique_ptr<SyntheticSource>> OpenSynthetic(const std::string& name,
                                                       const SynthConfig& config);
// The same as any other source.
Result<std::unique_ptr<FrameSource>> OpenSyntheticScene(const std::string& name,
                                                        const SynthConfig& config);

}  // namespace tessera
