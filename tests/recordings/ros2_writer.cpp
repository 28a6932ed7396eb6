#include "recordings/ros2_writer.h"

#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <array>

#include "recordings/ros_images_of.h"
#include "recordings/rvl_encoder.h"

namespace tessera::ros_test {
namespace {

template <class T>
void Raw(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}
void SizedText(std::string& bytes, const std::string& text) {
    Raw(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

// CDR: a head of four bytes; from its end, every number is aligned to its size.
class Cdr {
  public:
    template <class T>
    Cdr& Put(T value) {
        while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
        Raw(bytes_, value);
        return *this;
    }
    Cdr& Text(const std::string& text) {
        Put(static_cast<std::uint32_t>(text.size() + 1));
        bytes_ += text + '\0';
        return *this;
    }
    Cdr& Header(int frame, std::uint32_t late_ns, const std::string& frame_id) {
        Put(static_cast<std::int32_t>(1000 + frame / 10));
        Put(static_cast<std::uint32_t>(frame % 10) * 100'000'000u + late_ns);
        return Text(frame_id);
    }
    Cdr& Doubles(const std::vector<double>& values) {
        for (const double value : values) Put(value);
        return *this;
    }
    std::string bytes() const { return bytes_; }

  private:
    std::string bytes_{'\0', '\1', '\0', '\0'};
};

template <class Pixels>
std::string ImageOf(const Pixels& pixels, int frame, std::uint32_t late_ns,
                    const std::string& frame_id, const std::string& encoding) {
    const auto row_bytes = static_cast<std::uint32_t>(pixels.width()) * sizeof(*pixels.data());
    const auto bytes = row_bytes * static_cast<std::uint32_t>(pixels.height());
    Cdr cdr;
    cdr.Header(frame, late_ns, frame_id).Put(pixels.height()).Put(pixels.width());
    cdr.Text(encoding).Put('\0').Put(static_cast<std::uint32_t>(row_bytes));
    cdr.Put(static_cast<std::uint32_t>(bytes));
    return cdr.bytes() + std::string(reinterpret_cast<const char*>(pixels.data()), bytes);
}

std::string RvlImageOf(int frame, const std::string& encoding) {
    const Image<std::uint16_t> depth = DepthOf(frame);
    std::string data;
    for (const float value : {0.0f, kInverseA, kInverseB}) Raw(data, value);
    Raw(data, depth.width());
    Raw(data, depth.height());
    data += RvlOf({depth.data(), depth.size()});
    return CompressedImageOf(frame, "depth_optical", encoding + "; compressedDepth rvl", data);
}

std::string RecordOf(int opcode, const std::string& content) {
    std::string record(1, static_cast<char>(opcode));
    Raw(record, static_cast<std::uint64_t>(content.size()));
    return record + content;
}

std::string PackedChunk(const std::string& records, const std::string& compression) {
    std::string packed = records;
    if (compression == "lz4") {
        packed.resize(LZ4F_compressFrameBound(records.size(), nullptr));
        packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), records.data(),
                                         records.size(), nullptr));
    } else if (compression == "zstd") {
        packed.resize(ZSTD_compressBound(records.size()));
        packed.resize(
            ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 3));
    }
    std::string content(16, '\0');  // first and last time
    Raw(content, static_cast<std::uint64_t>(records.size()));
    Raw(content, std::uint32_t{0});  // no checksum
    SizedText(content, compression);
    Raw(content, static_cast<std::uint64_t>(packed.size()));
    return RecordOf(6, content + packed);
}

std::string SchemaAndChannel(std::uint16_t id, const Message& message) {
    std::string schema, channel;
    Raw(schema, id);
    for (const std::string& text : {message.type, std::string("ros2msg"), std::string()})
        SizedText(schema, text);
    Raw(channel, id);
    Raw(channel, id);
    for (const std::string& text : {message.topic, std::string("cdr"), std::string()})
        SizedText(channel, text);
    return RecordOf(3, schema) + RecordOf(4, channel);
}

}  // namespace

std::string DepthImageOf(int frame, const std::string& frame_id, const std::string& encoding) {
    return ImageOf(DepthOf(frame), frame, 0, frame_id, encoding);
}

std::string CompressedImageOf(int frame, const std::string& frame_id, const std::string& format,
                              const std::string& data) {
    Cdr cdr;
    cdr.Header(frame, 0, frame_id).Text(format);
    return cdr.Put(static_cast<std::uint32_t>(data.size())).bytes() + data;
}

std::string CameraInfoOf(int width, int height, double f, double cx, double cy,
                         const std::vector<double>& d, const std::string& frame) {
    Cdr cdr;
    cdr.Header(0, 0, frame).Put(height).Put(width).Text("plumb_bob");
    cdr.Put(static_cast<std::uint32_t>(d.size())).Doubles(d);
    cdr.Doubles({f, 0, cx, 0, f + 1, cy, 0, 0, 1}).Doubles(std::vector<double>(9));
    return cdr.Doubles({f - 1, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0}).bytes();
}

std::string TransformsOf(const std::vector<Link>& links) {
    Cdr cdr;
    cdr.Put(static_cast<std::uint32_t>(links.size()));
    for (const Link& link : links) cdr.Header(0, 0, "link").Text(link.child).Doubles(link.numbers);
    return cdr.bytes();
}

std::vector<Link> PlainLinks() {
    return {{"depth_optical", {0, 0, 0, 0, 0, 0, 1}},
            {"colour_optical", {0.015, 0, 0, 0, 0.6, 0, 0.8}}};
}

std::vector<Message> PlainMessages() {
    std::vector<Message> messages{
        {"/tf_static", "tf2_msgs/msg/TFMessage", 0, TransformsOf(PlainLinks())},
        {"/cam/depth/camera_info", "sensor_msgs/msg/CameraInfo", 0,
         CameraInfoOf(kDepthWidth, kDepthHeight, 60.5, 31.25, 23.75, std::vector<double>(5),
                      "depth_optical")},
        {"/cam/color/camera_info", "sensor_msgs/msg/CameraInfo", 0,
         CameraInfoOf(kColourWidth, kColourHeight, 91, 47.5, 35.25,
                      {0.1, -0.05, 0.001, -0.002, 0.01}, "colour_optical")}};
    for (int i = 0; i < kFrames; ++i) {
        messages.push_back({"/cam/depth/image_raw", "sensor_msgs/msg/Image", 2 * i + 1,
                            ImageOf(DepthOf(i), i, 0, "depth_optical", "16UC1")});
        messages.push_back({"/cam/color/image_raw", "sensor_msgs/msg/Image", 2 * i + 2,
                            ImageOf(ColourOf(i), i, 4'000'000, "colour_optical", "rgb8")});
    }
    return messages;
}

std::vector<Message> RvlMessages(bool floats) {
    std::vector<Message> messages = PlainMessages();
    int frame = 0;
    for (Message& message : messages)
        if (message.topic == "/cam/depth/image_raw")
            message = {message.topic + "/compressedDepth", "sensor_msgs/msg/CompressedImage",
                       message.time_ns, RvlImageOf(frame++, floats ? "32FC1" : "16UC1")};
    return messages;
}

std::string McapOf(const std::vector<Message>& messages, const std::string& compression) {
    const std::string magic("\x89MCAP0\r\n", 8);
    std::string header, file = magic, chunk;
    SizedText(header, "ros2");
    SizedText(header, "test");
    file += RecordOf(1, header);
    std::vector<std::string> topics;
    for (std::size_t i = 0; i < messages.size(); ++i) {
        const Message& message = messages[i];
        auto topic = std::ranges::find(topics, message.topic);
        const auto id = static_cast<std::uint16_t>(topic - topics.begin() + 1);
        if (topic == topics.end()) {
            topics.push_back(message.topic);
            chunk += SchemaAndChannel(id, message);
        }
        std::string content;
        Raw(content, id);
        Raw(content, static_cast<std::uint32_t>(i));
        Raw(content, message.time_ns);
        Raw(content, message.time_ns);
        chunk += RecordOf(5, content + message.data);
        if (i % 4 != 3 && i + 1 < messages.size()) continue;
        file += PackedChunk(chunk, compression);
        chunk.clear();
    }
    return file + RecordOf(15, std::string(4, '\0')) + RecordOf(2, std::string(20, '\0')) + magic;
}

void WriteDb3(const std::string& path, const std::vector<Message>& messages) {
    sqlite3* database = nullptr;
    sqlite3_open(path.c_str(), &database);
    const auto run = [&](const char* sql, const std::vector<std::string>& values) {
        sqlite3_stmt* statement = nullptr;
        sqlite3_prepare_v2(database, sql, -1, &statement, nullptr);
        for (std::size_t i = 0; i < values.size(); ++i)
            sqlite3_bind_blob(statement, static_cast<int>(i + 1), values[i].data(),
                              static_cast<int>(values[i].size()), SQLITE_STATIC);
        sqlite3_step(statement);
        sqlite3_finalize(statement);
    };
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)",
        {});
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
        "INTEGER NOT NULL, data BLOB NOT NULL)",
        {});
    run("BEGIN", {});
    std::vector<std::string> topics;
    for (const Message& message : messages) {
        if (std::ranges::find(topics, message.topic) == topics.end()) {
            topics.push_back(message.topic);
            run("INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES "
                "(CAST(? AS TEXT), CAST(? AS TEXT), 'cdr', '')",
                {message.topic, message.type});
        }
        run("INSERT INTO messages(topic_id, timestamp, data) VALUES ((SELECT id FROM topics WHERE "
            "name = CAST(? AS TEXT)), CAST(CAST(? AS TEXT) AS INTEGER), ?)",
            {message.topic, std::to_string(message.time_ns), message.data});
    }
    run("COMMIT", {});
    sqlite3_close(database);
}

}  // namespace tessera::ros_test
