// Precomputed detections, as in [D18], from a file (io/detections_text.h has its form).
#pragma once

#include <map>

#include "semantics/detector.h"

namespace tessera {

class DetectionsFile : public Detector {
  public:
    // Malformed lines, numbers out of range and files without detections are errors: "FILE:LINE:
    // ...".
    static Result<std::unique_ptr<DetectionsFile>> Read(const std::string& path);

    // Returns the detections whose stamp is within 2 ms of the frame's colour stamp, or else of its
    // depth stamp.
    Result<std::vector<Detection>> Detect(const Frame& frame) override;
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::map<double, std::vector<Detection>> by_stamp_;
    std::vector<std::string> names_;  // sorted
};

// Formats one line of the file, without newline.
std::string DetectionLine(double stamp_s, const std::string& class_name,
                          const Detection& detection);

}  // namespace tessera
