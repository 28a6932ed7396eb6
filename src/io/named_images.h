// Recordings without lists: what belongs together is in the files' names.
#pragma once

#include <string>

#include "core/status.h"
#include "io/image_lists.h"

namespace tessera {

// A 7-Scenes sequence: frame-NNNNNN.color.png and .depth.png; stamps are NNNNNN / fps. Frames
// without a depth or a colour image are noted. Paths are relative to the folder.
Result<ImagePairs> ReadSevenScenesNames(const std::string& folder, double fps);

// The subfolders of images of a folder: depth/ and one of rgb/, colour/, color/, image/, images/;
// empty if not there.
struct ImageFolders {
    std::string depth, colour;
    bool complete() const { return !depth.empty() && !colour.empty(); }
};
ImageFolders FindImageFolders(const std::string& folder);

// Pairs two subfolders' images by their names: by time where the names are stamps (seconds with a
// decimal point, or 13, 16, 19 digits of milli-, micro-, nanoseconds); else by the last number in
// them, stamps being number / fps; else, where names have no number, in alphabetical order. Numbers
// or names that do not match are noted or an error.
Result<ImagePairs> PairByName(const std::string& folder, const ImageFolders& folders, double fps,
                              double max_gap_s);

}  // namespace tessera
