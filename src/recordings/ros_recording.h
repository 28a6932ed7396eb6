// Recordings of ROS: a .bag of ROS 1, also as RealSense's own tools write it, or a .mcap or .db3
// of ROS 2, or the folder that holds some of these.
#pragma once

#include <string>

#include "recordings/recording.h"
#include "recordings/ros_choice.h"

namespace tessera {

// A file that rosbag2 has compressed as a whole: .mcap.zstd or .db3.zstd. It is not read; the error
// says what to do.
bool IsCompressedRosFile(const std::string& path);

// Whether the folder is a ROS 2 recording: it holds a .mcap or .db3 file, perhaps compressed.
bool IsRosFolder(const std::string& path);

// Images are paired by the stamps in their headers, less than max_pair_gap_s apart (0: PairGap).
// `colour_delay_s`: colour was taken so much later than its stamps say. `wanted`: which topics.
RecordingResult OpenRosRecording(const std::string& path, double max_pair_gap_s,
                                 double colour_delay_s = 0, const RosTopics& wanted = {});

}  // namespace tessera
