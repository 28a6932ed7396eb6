// What a recorded folder holds: recognised once, before a single image is decoded.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/status.h"

namespace tessera {

struct FolderFrame {
    double depth_stamp_s = 0, colour_stamp_s = 0;
    std::string depth_path, colour_path;
    std::optional<Eigen::Isometry3d> T_world_camera;  // ground truth at depth_stamp_s
};

struct FolderLayout {
    std::string kind;  // "TUM RGB-D folder", "ICL-NUIM folder", "7-Scenes sequence", "image folder"
    CameraCalibration calibration;
    // False: nobody says; the calibration is empty but for its frame rate.
    bool camera_known = true;
    std::uint16_t invalid_depth = 0;  // a stored value that means "no measurement", beside 0
    std::vector<FolderFrame> frames;  // strictly increasing depth stamps, at least one
    std::vector<std::string> notes;   // what a person should know
};

// Recognised, in this order:
// - TUM RGB-D: rgb.txt and depth.txt.
// - associations.txt: "stamp file stamp file", ICL-NUIM's among them. Stamps are kept as they are,
// so ICL-NUIM's are
//   frame numbers, as in its ground truth. Its poses are in a y-up, left-handed world (hence its
//   negative fy); they are reflected into ours: T_world_camera = M T M with M = diag(1, -1, 1).
// - 7-Scenes: frame-NNNNNN.color.png, .depth.png, .pose.txt. Colour is not registered to depth in
// this data set and is
//   used as it is: colours lie up to some centimetres beside their surface.
// - a folder with camera.yaml and subfolders depth/ and rgb/ (colour/, color/, image/, images/),
// paired by name. The camera: camera.yaml; else the published values that the folder's name
// (freiburg1, 2, 3), the bag's name in rgb.txt's second line or the layout gives; else unknown
// (nominal_camera.h). Ground truth: groundtruth.txt, or the layout's
// own; one that cannot be used is noted. Files that the lists name and that are absent are noted,
// all absent is an error.
Result<FolderLayout> ReadFolderLayout(const std::string& folder, double max_pair_gap_s);

}  // namespace tessera
