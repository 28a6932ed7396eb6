#include "semantics/open_detector.h"

#include "semantics/detections_file.h"
#include "semantics/dnn_detector.h"
#include "semantics/synthetic_detector.h"

namespace tessera {
namespace {

Result<std::unique_ptr<Detector>> OpenDetector(const std::string& name, const std::string& source,
                                               const SynthConfig& synthetic,
                                               const LabelConfig& config) {
    if (name == "synthetic") return OpenSyntheticDetector(source, synthetic, config);
    for (const char* end : {".onnx", ".cfg", ".weights"})
        if (name.ends_with(end)) return OpenDnnDetector(name, config);
    Result<std::unique_ptr<DetectionsFile>> file = DetectionsFile::Read(name);
    if (!file.ok()) return file.status();
    return std::unique_ptr<Detector>(std::move(file.value()));
}

}  // namespace

Result<Labelling> OpenLabelling(const std::string& name, const std::string& source,
                                const SynthConfig& synthetic, const LabelConfig& config) {
    if (Status status = config.Validate(); !status.ok()) return status;
    Result<std::unique_ptr<Detector>> detector = OpenDetector(name, source, synthetic, config);
    if (!detector.ok()) return detector.status();
    Result<LabelClasses> classes = LabelClasses::Make(config, detector.value()->class_names());
    if (!classes.ok()) return Status::Error(name + ": " + classes.message());
    return Labelling{std::move(detector.value()), std::move(classes.value())};
}

}  // namespace tessera
