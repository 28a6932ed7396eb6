// Lists of images as recordings carry them: TUM's rgb.txt and depth.txt, and associations.txt.
#pragma once

#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// A depth image and the colour image that belongs to it; paths as written in the list (relative to
// the folder).
struct ImagePair {
    double depth_stamp_s = 0, colour_stamp_s = 0;
    std::string depth, colour;
};

struct ImagePairs {
    std::vector<ImagePair> pairs;    // strictly increasing depth stamps
    std::vector<std::string> notes;  // what was skipped, sorted or left over, with counts
};

// Two lists of lines "stamp filename" ('#' starts a comment), paired by nearest time
// (stamp_pairing.h). Lines that are nothing of the kind and repeated stamps are skipped, disorder
// is sorted; each is noted. A list without any usable line, and lists without a pair less than
// max_gap_s apart, are errors.
Result<ImagePairs> ReadImageLists(const std::string& depth_list, const std::string& colour_list,
                                  double max_gap_s);

// Lines "stamp filename stamp filename": the depth image is the one with "depth" in its name, first
// or second. Taken as they stand, however far the stamps are apart.
Result<ImagePairs> ReadAssociations(const std::string& list);

}  // namespace tessera
