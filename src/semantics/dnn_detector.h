// Detection networks run by OpenCV's DNN module: ONNX (YOLOX, YOLOv5, YOLOv8; the latter two
// optionally with masks) and Darknet (FILE.cfg with FILE.weights).
#pragma once

#include "semantics/detector.h"

namespace tessera {

// True if this build includes OpenCV's DNN module.
bool HasDnn();

// Loads FILE.onnx, or FILE.cfg together with FILE.weights, and runs the network once. Errors name
// the file. They report a missing or damaged file, outputs of no known family, or a class list of
// the wrong length.
Result<std::unique_ptr<Detector>> OpenDnnDetector(const std::string& path,
                                                  const LabelConfig& config);

}  // namespace tessera
