// Without OpenCV's DNN module.
#include "semantics/dnn_detector.h"

namespace tessera {

bool HasDnn() { return false; }

Result<std::unique_ptr<Detector>> OpenDnnDetector(const std::string& path, const LabelConfig&) {
    return Status::Error(path +
                         ": this build has no networks (install libopencv-dnn-dev and build "
                         "again); a detections file "
                         "works without");
}

}  // namespace tessera
