// Recordings without lists: images are paired by their file names.
#pragma once

#include <string>

#include "core/status.h"
#include "io/image_lists.h"

namespace tessera {

// Reads a 7-Scenes sequence: frame-NNNNNN.color.png and .depth.png; stamps are NNNNNN / fps. Frames
// without a depth or a colour image are reported in the notes. Paths are relative to the folder.
Result<ImagePairs> ReadSevenScenesNames(const std::string& folder, double fps);

// Image subfolders of a folder: depth/ and one of rgb/, colour/, color/, image/, images/; empty if
// missing.
struct ImageFolders {
    std::string depth, colour;
    bool complete() const { return !depth.empty() && !colour.empty(); }
};
ImageFolders FindImageFolders(const std::string& folder);

// Pairs the images of two subfolders by name. If the names are stamps (seconds with a decimal
// point, or whole numbers as StampOfDigits_s reads them), pairs by time (PairGap). Otherwise pairs
// by the last number in the names, with stamps number / fps. If names have no number, pairs in
// alphabetical order. Unpaired images are reported in the notes; if there are no pairs, that is an
// error. `colour_delay_s`: as for ReadImageLists.
Result<ImagePairs> PairByName(const std::string& folder, const ImageFolders& folders, double fps,
                              double max_gap_s, double colour_delay_s = 0);

}  // namespace tessera
