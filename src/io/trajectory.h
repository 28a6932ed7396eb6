// Trajectories in the format of the TUM RGB-D tools: "stamp tx ty tz qx qy qz qw" per line,
// T_world_camera, seconds and metres; '#' starts a comment.
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

// Bad single lines (NaN, repeated stamps, zero quaternions) are skipped with a note; stamps out of
// order are sorted, with a note. A file without any pose, or with lines that are not numbers, is an
// error.
Result<Trajectory> ReadTrajectory(const std::string& path);

// Where the clock starts again, the poses before go to files of their own: NAME_1.txt and so on.
Status WriteTrajectory(const std::string& path, const std::vector<StampedPose>& poses);
// "a/NAME.txt" becomes "a/NAME_2.txt".
std::string NumberedPath(const std::string& path, int number);

// KITTI odometry format: per pose, the first three rows of T_world_camera, twelve numbers, row by
// row. The format has no stamps; they are written one per line to a second file with ".times"
// appended to the name.
Status WriteKittiPoses(const std::string& path, const std::vector<StampedPose>& poses);

// True if the clock started again between two poses that follow each other: another recording.
inline bool StartsAgain(double before_s, double after_s) { return after_s < before_s - 1; }
// Splits the path of a scan of several recordings where the clock starts again. At least one part,
// which may be empty.
std::vector<std::vector<StampedPose>> SplitByClock(const std::vector<StampedPose>& poses);

// Returns one line of a TUM file, without newline: stamp with 6 decimals, translation and
// quaternion with 9.
std::string TrajectoryLine(const StampedPose& pose);

// The pose at `stamp_s`, interpolated between its neighbours (slerp, linear). nullopt if stamp_s is
// out of range or the gap between the neighbours exceeds max_gap_s.
std::optional<Eigen::Isometry3d> InterpolatePose(const std::vector<StampedPose>& poses,
                                                 double stamp_s, double max_gap_s = 0.1);
// As InterpolatePose; where that gives none, the pose nearest in time if it is at most `nearest_s`
// away. `poses` must be sorted.
std::optional<Eigen::Isometry3d> PoseAt(const std::vector<StampedPose>& poses, double stamp_s,
                                        double nearest_s = 0.02);

}  // namespace tessera
