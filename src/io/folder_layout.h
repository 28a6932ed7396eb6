// Detects the layout of a recorded folder and lists its frames, before any image is decoded.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
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
    // False if the camera is unknown. The calibration then holds nothing but its frame rate.
    bool camera_known = true;
    std::string camera_from;          // as in SourceInfo; "": unknown
    bool registration_known = true;   // false: the colour camera's place is another device's
    std::uint16_t invalid_depth = 0;  // a stored value that means "no measurement", besides 0
    StampCorrection correction;       // already in the frames' stamps
    std::vector<FolderFrame> frames;  // strictly increasing depth stamps, at least one
    std::vector<std::string> notes;   // things the user should know
    // Signs that the recording is not read as it was meant.
    std::vector<std::string> warnings;
};

// In the message about a folder that has none of the layouts below.
inline constexpr const char* kUnknownLayout = "not a known sequence layout";

// Layouts are tried in this order:
// - TUM RGB-D: rgb.txt and depth.txt.
// - associations.txt with lines "stamp file stamp file"; ICL-NUIM uses this. A folder with lists is
//   ICL-NUIM's if it has a NAME.gt.freiburg, or if its stamps are frame numbers and either it has
//   ICL-NUIM's name ("living_room", ...) or associations.txt and no camera.yaml. Stamps are kept as
//   they are, so ICL-NUIM's are frame numbers, as in its ground truth. Its poses are in a y-up,
//   left-handed world (hence its negative fy). They are reflected into ours:
//   T_world_camera = M T M with M = diag(1, -1, 1).
// - 7-Scenes: frame-NNNNNN.color.png, .depth.png, .pose.txt. Colour is not registered to depth in
//   this data set, and its calibration is not published: that of another Kinect is used.
// - A folder with subfolders depth/ and rgb/ (colour/, color/, image/, images/), paired by name.
// Camera: camera.yaml if present; otherwise Open3D's (open3d_camera.h); otherwise the published
// values, identified by the folder's name (freiburg1, 2, 3), by the bag name in the first two lines
// of rgb.txt, or by the layout; otherwise unknown (nominal_camera.h). Ground truth:
// groundtruth.txt, or the layout's own. Unusable ground truth is reported in the notes. So are
// files that the lists name but that are missing; if all are missing, that is an error. Time stamps
// are corrected by `colour_delay_s` (frame.h) before images are paired, unless they are frame
// numbers. `depth_scale_set`: the user has set the depth unit, so that no note says what is
// assumed.
Result<FolderLayout> ReadFolderLayout(const std::string& folder, double max_pair_gap_s,
                                      double colour_delay_s = 0, bool depth_scale_set = false);

}  // namespace tessera
