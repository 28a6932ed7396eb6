// Trajectories as the TUM RGB-D tools write them: "stamp tx ty tz qx qy qz qw" per line,
// T_world_camera, seconds and metres, '#' starts a comment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

struct Trajectory {
    std::vector<StampedPose> poses;  // strictly increasing stamps
    // What was skipped: NaN, repeated stamps, zero quaternions; "file:line: why".
    std::vector<std::string> notes;
};

// Bad single lines (NaN, repeated or decreasing stamps that sorting cannot mend, zero quaternion)
// are skipped and noted; a file without any pose, or with lines that are no numbers at all, is an
// error.
Result<Trajectory> ReadTrajectory(const std::string& path);

Status WriteTrajectory(const std::string& path, const std::vector<StampedPose>& poses);

// As KITTI's odometry benchmark has them: per pose the first three rows of T_world_camera, twelve
// numbers, row by row. Such files have no stamps: those go, one a line, into a second file of that
// name with ".times" appended.
Status WriteKittiPoses(const std::string& path, const std::vector<StampedPose>& poses);

// One line of a TUM file, without newline: stamps with 6 decimals, translations and quaternions
// with 9.
std::string TrajectoryLine(const StampedPose& pose);

// The pose at `stamp_s`, interpolated between its neighbours (slerp, linear); nothing if outside or
// if the gap between the neighbours exceeds max_gap_s.
std::optional<Eigen::Isometry3d> InterpolatePose(const std::vector<StampedPose>& poses,
                                                 double stamp_s, double max_gap_s = 0.1);

}  // namespace tessera
