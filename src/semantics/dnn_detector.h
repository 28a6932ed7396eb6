// Detection networks through OpenCV's DNN module: ONNX (YOLOX, YOLOv5, YOLOv8, the latter two also
// with masks) and Darknet (FILE.cfg with its FILE.weights).
#pragma once

#include "semantics/detector.h"

namespace tessera {

// Whether this build has OpenCV's DNN module.
bool HasDnn();

// Loads FILE.onnx, or FILE.cfg or FILE.weights and its sister, and tries the network once. Errors
// name the file: missing, damaged, outputs that are no known family's, a class list of another
// length.
Result<std::unique_ptr<Detector>> OpenDnnDetector(const std::string& path,
                                                  const LabelConfig& config);

}  // namespace tessera
