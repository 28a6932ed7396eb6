// Stub for builds without OpenCV's DNN module.
#include "semantics/dnn_detector.h"

namespace tessera {

bool HasDnn() { return false; }

Result<std::unique_ptr<Detector>> OpenDnnDetector(const std::string& path, const LabelConfig&) {
    return Status::Error(path +
                         ": this build cannot run networks; install libopencv-dnn-dev and rebuild, "
                         "or use a detections file");
}

}  // namespace tessera
