// A file of ROS messages: a ROS 1 bag, or a ROS 2 recording as .mcap or .db3.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "recordings/ros_message.h"

namespace tessera {

struct MessageTopic {
    std::string name;  // "/camera/depth/image_raw"
    std::string type;  // "sensor_msgs/Image", without ROS 2's "/msg"
    RosSerialisation serialisation = RosSerialisation::kRos1;
};

// "sensor_msgs/Image" of "sensor_msgs/msg/Image".
inline std::string RosTypeOf(std::string name) {
    if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
    return name;
}

// Where a message is; what the numbers mean is the file's own business.
struct MessagePlace {
    std::uint64_t chunk = 0, offset = 0;
    std::uint64_t bytes = 0;
    double received_s = 0;  // when it was recorded
};

// Owner thread only. Content is not trusted. Errors do not name the file.
class MessageFile {
  public:
    static constexpr std::size_t kHeadBytes = 256;
    static constexpr std::uint64_t kMostMessageBytes = std::uint64_t{256} << 20;

    virtual ~MessageFile() = default;

    // All messages in the file's order: their topic, place and first bytes, at most kHeadBytes. A
    // topic keeps its address for as long as the file is open. Damage ends the walk with an error;
    // what came before is good.
    using Take = std::function<void(const MessageTopic&, const MessagePlace&, ByteView head)>;
    virtual Status ForEach(const Take& take) = 0;
    // The whole message.
    virtual Status Read(const MessagePlace& place, std::vector<std::uint8_t>& bytes) = 0;
};

using MessageFileResult = Result<std::unique_ptr<MessageFile>>;
MessageFileResult OpenBagFile(const std::string& path);
MessageFileResult OpenMcapFile(const std::string& path);
// An error if the program was built without SQLite.
MessageFileResult OpenDb3File(const std::string& path);

}  // namespace tessera
