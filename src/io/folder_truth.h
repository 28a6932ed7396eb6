// The ground truth that recorded folders bring along.
#pragma once

#include <string>

#include "io/folder_layout.h"

namespace tessera {

// ICL-NUIM's ground truth file (*.gt.freiburg) in the folder; empty if there is none or more than
// one.
std::string FindIclTruth(const std::string& folder);

// Gives each frame of the layout its true pose, where the folder has one: groundtruth.txt,
// ICL-NUIM's file (reflected, see folder_layout.h), or 7-Scenes' frame-NNNNNN.pose.txt.
// Interpolated over gaps of at most 0.1 s, or of one frame where stamps are frame numbers. What
// cannot be used is noted.
void AddTruth(const std::string& folder, bool stamps_are_frame_numbers, FolderLayout& layout);

}  // namespace tessera
