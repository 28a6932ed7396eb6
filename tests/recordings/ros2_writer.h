// Writes ROS 2 recordings from the published formats only: CDR, MCAP (mcap.dev/spec) and rosbag2's
// SQLite schema. No program in Debian writes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessera::ros_test {

struct Message {
    std::string topic, type;  // "sensor_msgs/msg/Image"
    std::int64_t time_ns = 0;
    std::string data;  // CDR
};

// The same content as write_bag.py's "plain".
std::vector<Message> PlainMessages();
// The same, with depth by compressed_depth_image_transport as RVL; as inverse depth if `floats`:
// a / (stored - b) metres of stored = DepthOf, with a = kInverseA, b = kInverseB.
std::vector<Message> RvlMessages(bool floats);
inline constexpr float kInverseA = 2000, kInverseB = -1000;

// The data of single messages. DepthOf(frame) in another encoding of 16 bits:
std::string DepthImageOf(int frame, const std::string& frame_id, const std::string& encoding);
std::string CompressedImageOf(int frame, const std::string& frame_id, const std::string& format,
                              const std::string& data);
// P has f - 1 and f where K has f and f + 1.
std::string CameraInfoOf(int width, int height, double f, double cx, double cy,
                         const std::vector<double>& d, const std::string& frame);
// From "link" to a child frame: x y z, and the rotation qx qy qz qw.
struct Link {
    std::string child;
    std::vector<double> numbers;
};
std::string TransformsOf(const std::vector<Link>& links);
// Those of the recordings.
std::vector<Link> PlainLinks();

// `compression`: "", "lz4" or "zstd". A chunk holds four messages.
std::string McapOf(const std::vector<Message>& messages, const std::string& compression);
void WriteDb3(const std::string& path, const std::vector<Message>& messages);

}  // namespace tessera::ros_test
