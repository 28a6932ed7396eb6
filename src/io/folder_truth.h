// Ground truth stored in recorded folders.
#pragma once

#include <string>

#include "io/folder_layout.h"

namespace tessera {

// Returns ICL-NUIM's ground truth file (*.gt.freiburg) in the folder; empty if there is none or
// more than one.
std::string FindIclTruth(const std::string& folder);

// Sets the true pose of each frame of the layout if the folder has ground truth: groundtruth.txt,
// ICL-NUIM's file (reflected, see folder_layout.h), or 7-Scenes' frame-NNNNNN.pose.txt. Poses from
// a trajectory are interpolated over gaps of at most 0.1 s, or of one frame if stamps are frame
// numbers. Problems are reported in the notes.
void AddTruth(const std::string& folder, bool stamps_are_frame_numbers, FolderLayout& layout);

}  // namespace tessera
