// The 80 classes of the COCO data set in its usual order: what most published detectors know.
#pragma once

#include <string>
#include <vector>

namespace tessera {

std::vector<std::string> CocoNames();

}  // namespace tessera
