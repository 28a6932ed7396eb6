// Detections made beforehand, the way of [D18]: lines "stamp class probability xmin ymin xmax
// ymax", pixels inclusive, "_" for blanks in a class's name, '#' starts a comment.
#pragma once

#include <map>

#include "semantics/detector.h"

namespace tessera {

class DetectionsFile : public Detector {
  public:
    // A line of another form, a number out of range or a file without any line is an error:
    // "FILE:LINE: ...".
    static Result<std::unique_ptr<DetectionsFile>> Read(const std::string& path);

    // Those of the frame's colour image, else of its depth image, by time stamp within 2 ms.
    Result<std::vector<Detection>> Detect(const Frame& frame) override;
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::map<double, std::vector<Detection>> by_stamp_;
    std::vector<std::string> names_;  // sorted
};

// One such line, without newline.
std::string DetectionLine(double stamp_s, const std::string& class_name,
                          const Detection& detection);

}  // namespace tessera
