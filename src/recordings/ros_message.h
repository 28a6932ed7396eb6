// The few ROS messages that a depth camera's recording needs, read from the bytes of ROS 1's
// serialisation or of ROS 2's CDR. Views point into the bytes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

enum class RosSerialisation { kRos1, kCdr };

using ByteView = std::span<const std::uint8_t>;

// RealSense's own bags have this instead of a frame's name.
inline constexpr std::string_view kRealsenseFrame = "1";

struct RosHeader {
    double stamp_s = 0;
    std::string_view frame_id;
};

// sensor_msgs/Image
struct RosImage {
    RosHeader header;
    std::uint32_t height = 0, width = 0;  // pixels
    std::string_view encoding;
    bool big_endian = false;
    std::uint32_t row_bytes = 0;
    ByteView data;
    // Metres of a stored depth value, which only RealSense's own bags say (librealsense,
    // third-party/realsense-file/rosbag/msgs/sensor_msgs/Image.h); 0: not said.
    float depth_unit_m = 0;
};

// sensor_msgs/CompressedImage
struct RosCompressedImage {
    RosHeader header;
    std::string_view format;
    ByteView data;
};

// sensor_msgs/CameraInfo
struct RosCameraInfo {
    RosHeader header;
    std::uint32_t height = 0, width = 0;  // pixels
    std::string_view distortion_model;
    std::vector<double> distortion;
    std::array<double, 9> k{};   // row-major intrinsic matrix of the raw image
    std::array<double, 12> p{};  // row-major 3 x 4 projection matrix of the rectified image
};

// geometry_msgs/TransformStamped
struct RosTransform {
    RosHeader header;
    std::string_view child_frame_id;
    Eigen::Isometry3d T_frame_child = Eigen::Isometry3d::Identity();
};

// All return nullopt if the bytes are too few or make no sense.
std::optional<RosHeader> ParseHeader(RosSerialisation serialisation, ByteView bytes);
std::optional<RosImage> ParseImage(RosSerialisation serialisation, ByteView bytes);
std::optional<RosCompressedImage> ParseCompressedImage(RosSerialisation serialisation,
                                                       ByteView bytes);
std::optional<RosCameraInfo> ParseCameraInfo(RosSerialisation serialisation, ByteView bytes);
// tf2_msgs/TFMessage. Leaves out those whose numbers are no transform.
std::vector<RosTransform> ParseTransforms(RosSerialisation serialisation, ByteView bytes);
// geometry_msgs/Transform
std::optional<Eigen::Isometry3d> ParseTransform(RosSerialisation serialisation, ByteView bytes);

}  // namespace tessera
