// Image lists of recordings: TUM's rgb.txt and depth.txt, and associations.txt.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/status.h"

namespace tessera {

// A depth image and its colour image. Paths are as written in the list (relative to the folder).
struct ImagePair {
    double depth_stamp_s = 0, colour_stamp_s = 0;
    std::string depth, colour;
};

struct ImagePairs {
    std::vector<ImagePair> pairs;    // strictly increasing depth stamps
    std::vector<std::string> notes;  // what was skipped, sorted or left over, with counts
    std::size_t listed = 0;          // depth images that were there to be paired
};

// A time since 1970 as a whole number of 13, 16 or 19 digits, which are milli-, micro- or
// nanoseconds: the seconds nearest to it. nullopt for other texts, such as a frame's number with
// zeros before it.
std::optional<double> StampOfDigits_s(std::string_view digits);

// Reads two lists of lines "stamp filename" ('#' starts a comment; the name may contain blanks) and
// pairs them by nearest time (stamp_pairing.h). Stamps are in seconds, or whole numbers as
// StampOfDigits_s reads them. Malformed lines and repeated stamps are skipped, unordered lists are
// sorted; each is reported in the notes. It is an error if a list has no usable line, or if no two
// images are less than max_gap_s apart (0: PairGap). `colour_delay_s`: colour was taken so much
// later than its stamps say; the stamps are not changed.
Result<ImagePairs> ReadImageLists(const std::string& depth_list, const std::string& colour_list,
                                  double max_gap_s, double colour_delay_s = 0);

// Reads lines "stamp filename stamp filename". The depth image is the one with "depth" in its name,
// first or second. The pairs are taken as they are, however far apart their stamps.
Result<ImagePairs> ReadAssociations(const std::string& list);

// True if all stamps of depth are whole numbers of a plausible count of frames.
bool StampsAreFrameNumbers(const std::vector<ImagePair>& pairs);

// What the user should know about stamps that are damaged, or in another unit than seconds: they
// leave few pairs, or leap. Usually empty.
std::vector<std::string> StampWarnings(const ImagePairs& images);

}  // namespace tessera
