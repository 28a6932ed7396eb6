#include "semantics/synthetic_detector.h"

#include "synth/simulated_detector.h"

namespace tessera {
namespace {

class SyntheticDetector : public Detector {
  public:
    SyntheticDetector(std::unique_ptr<SyntheticSource> source, const LabelConfig& config)
        : source_(std::move(source)), config_(config) {
        const std::vector<std::string>& names = source_->scene().class_names();
        names_.assign(names.begin() + 1, names.end());
    }

    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        if (!frame.T_world_camera)
            return Status::Error("--labels synthetic: the frame has no ground-truth pose");
        const Scene& scene = source_->scene();
        const Image<std::uint16_t> instances = CastInstances(
            scene, source_->info().camera, *frame.T_world_camera, frame.stamp_s - kFirstStamp_s);
        std::vector<Detection> detections;
        for (const SimulatedDetection& d : SimulateDetections(
                 scene, FindInstanceBoxes(instances, scene.instances().size()), instances.size(),
                 static_cast<std::uint64_t>(config_.synthetic_seed), frame.index,
                 {config_.synthetic_missed, config_.synthetic_wrong})) {
            Detection detection;
            detection.name = scene.class_names()[static_cast<std::size_t>(d.class_id)];
            detection.probability = static_cast<float>(d.probability);
            detection.box = {static_cast<float>(d.box.x_min), static_cast<float>(d.box.y_min),
                             static_cast<float>(d.box.x_max), static_cast<float>(d.box.y_max)};
            detections.push_back(std::move(detection));
        }
        return detections;
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::unique_ptr<SyntheticSource> source_;
    LabelConfig config_;
    std::vector<std::string> names_;
};

}  // namespace

Result<std::unique_ptr<Detector>> OpenSyntheticDetector(const std::string& source,
                                                        const SynthConfig& synthetic,
                                                        const LabelConfig& config) {
    if (!source.starts_with("synthetic:"))
        return Status::Error("--labels synthetic: " + source +
                             " is not a synthetic: source; give a network or a detections file");
    Result<std::unique_ptr<SyntheticSource>> opened = OpenSynthetic(source, synthetic);
    if (!opened.ok()) return opened.status();
    return std::unique_ptr<Detector>(
        std::make_unique<SyntheticDetector>(std::move(opened.value()), config));
}

}  // namespace tessera
