// What is in a ROS recording: its image topics, cameras and transforms. Reads only the first image
// of each topic, or a few more where that is damaged.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "recordings/message_file.h"
#include "recordings/ros_transforms.h"

namespace tessera {

struct RosImagePlace {
    double stamp_s = 0;
    std::size_t file = 0;
    MessagePlace place;
};

// An image topic.
struct RosStream {
    std::string topic;
    std::string frame_id;
    bool is_depth = false;
    bool is_grey = false;        // neither depth nor colour
    bool is_compressed = false;  // CompressedImage
    RosSerialisation serialisation = RosSerialisation::kRos1;
    int width = 0, height = 0;          // pixels; 0: its images are of no use
    std::string unread;                 // why they are of no use
    double depth_scale = 1000;          // stored value of one metre
    bool depth_in_m = false;            // as in RecordingInfo
    std::vector<RosImagePlace> images;  // stamps increase
};

struct RosCamera {
    CameraCalibration raw;  // of images with the lens's distortion
    PinholeCamera rectified;
    std::string frame_id;
    std::string warning;  // if the lens's distortion cannot be corrected well
};

struct RosContents {
    std::vector<RosStream> streams;
    std::map<std::string, RosCamera> cameras;  // by the topic of their CameraInfo; none of zeros
    RosTransforms transforms;
    // RealSense's own bags: the transform from the device to the stream, by the stream's prefix,
    // "/device_0/sensor_0/Depth_0".
    std::map<std::string, Eigen::Isometry3d> realsense_extrinsics;
    std::vector<std::string> notes;        // images that are not read
    std::vector<std::string> warnings;     // damage, missing stamps
    bool has_compressed_messages = false;  // rosbag2's compression mode MESSAGE: not read
};

// Damage ends the walk through a file, with a warning. Where no header of a topic has a stamp, or
// more than half of them repeat another's, the times at which its messages were recorded are taken,
// with a warning. Of images with one stamp the first is kept. At most 1000 image topics.
RosContents ScanRosFiles(std::span<const std::unique_ptr<MessageFile>> files);

}  // namespace tessera
