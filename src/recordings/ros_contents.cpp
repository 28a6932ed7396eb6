#include "recordings/ros_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/printable.h"
#include "recordings/ros_images.h"
#include "recordings/ros_lens.h"

namespace tessera {
namespace {

PinholeCamera RosPinhole(const RosCameraInfo& info, double fx, double fy, double cx, double cy) {
    constexpr std::uint32_t kMost = 65535;
    return {.width = static_cast<int>(std::min(info.width, kMost)),
            .height = static_cast<int>(std::min(info.height, kMost)),
            .fx = fx,
            .fy = fy,
            .cx = cx,
            .cy = cy};
}

// sensor_msgs/CameraInfo.msg says what the numbers mean.
RosCamera CameraOf(const RosCameraInfo& info) {
    RosCamera camera;
    camera.frame_id = std::string(info.header.frame_id);
    camera.raw.pinhole = RosPinhole(info, info.k[0], info.k[4], info.k[2], info.k[5]);
    camera.rectified = info.p[0] > 0 ? RosPinhole(info, info.p[0], info.p[5], info.p[2], info.p[6])
                                     : camera.raw.pinhole;
    RosLens lens = RosLensOf(info);
    camera.raw.distortion = lens.lens;
    camera.warning = std::move(lens.warning);
    return camera;
}

// Zeros stand for none: "clients may assume that K[0] == 0.0 indicates an uncalibrated camera"
// (sensor_msgs/CameraInfo.msg).
bool HasCalibration(const RosCameraInfo& info) {
    return info.k[0] != 0 && info.width > 0 && info.height > 0;
}

bool IsGreyEncoding(std::string_view encoding) { return encoding == "mono8" || encoding == "8UC1"; }

// CDR begins with 0.
bool IsZstd(ByteView message) {
    constexpr std::uint8_t kZstdMagic[] = {0x28, 0xb5, 0x2f, 0xfd};
    return message.size() >= sizeof(kZstdMagic) &&
           std::equal(std::begin(kZstdMagic), std::end(kZstdMagic), message.begin());
}

// Takes messages, and keeps what the recording needs.
class RosScan {
  public:
    RosScan(MessageFile& file, std::size_t number, RosContents& contents)
        : file_(file), number_(number), contents_(contents) {}

    Status Run() {
        return file_.ForEach([this](const MessageTopic& topic, const MessagePlace& place,
                                    ByteView head) { Take(topic, place, head); });
    }

  private:
    void Take(const MessageTopic& topic, const MessagePlace& place, ByteView head) {
        if (topic.serialisation == RosSerialisation::kCdr && IsZstd(head)) {
            contents_.has_compressed_messages = true;
            return;
        }
        if (topic.type == "sensor_msgs/Image" || topic.type == "sensor_msgs/CompressedImage")
            TakeImage(topic, place, head);
        else if (topic.type == "sensor_msgs/CameraInfo")
            TakeCamera(topic, place);
        else if (topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage")
            TakeTransforms(topic, place);
        else if (topic.type == "geometry_msgs/Transform" && topic.name.starts_with("/device_"))
            TakeExtrinsics(topic, place);
    }

    void TakeImage(const MessageTopic& topic, const MessagePlace& place, ByteView head) {
        constexpr std::size_t kLongestName = 255;  // as in ROS 2
        if (topic.name.size() > kLongestName) return;
        const auto header = ParseHeader(topic.serialisation, head);
        if (!header) return;
        auto stream = std::ranges::find(contents_.streams, topic.name, &RosStream::topic);
        if (stream == contents_.streams.end()) {
            constexpr std::size_t kMostTopics = 1000;
            if (contents_.streams.size() >= kMostTopics) return;
            contents_.streams.emplace_back();
            stream = std::prev(contents_.streams.end());
            stream->topic = topic.name;
            stream->serialisation = topic.serialisation;
            stream->is_compressed = topic.type == "sensor_msgs/CompressedImage";
        }
        constexpr std::size_t kMostTried = 5;  // the first ones may be damaged
        if (stream->width <= 0 && stream->images.size() < kMostTried) DescribeBy(place, *stream);
        stream->images.push_back({header->stamp_s, number_, place});
    }

    void DescribeBy(const MessagePlace& place, RosStream& stream) {
        stream.unread = "its first messages are damaged";
        if (!file_.Read(place, message_).ok()) return;
        if (stream.is_compressed)
            DescribeCompressed(stream);
        else if (const auto image = ParseImage(stream.serialisation, message_))
            Describe(*image, stream);
    }
    static void Describe(const RosImage& image, RosStream& stream) {
        stream.is_depth = IsDepthEncoding(image.encoding);
        if (!stream.is_depth && !IsColourEncoding(image.encoding)) {
            stream.unread = fmt::format("images in the encoding '{}' are not read",
                                        Printable(image.encoding, kQuotedBytes));
            return;
        }
        stream.is_grey = IsGreyEncoding(image.encoding);
        stream.frame_id = std::string(image.header.frame_id);
        stream.width = static_cast<int>(image.width);
        stream.height = static_cast<int>(image.height);
        stream.depth_scale = RosDepthScale(image.encoding);
        stream.depth_in_m = IsRosDepthInMetres(image.encoding);
        if (image.depth_unit_m > 1e-6f && image.depth_unit_m < 0.1f)
            stream.depth_scale = 1 / static_cast<double>(image.depth_unit_m);
    }
    void DescribeCompressed(RosStream& stream) {
        const auto image = ParseCompressedImage(stream.serialisation, message_);
        if (!image) return;
        stream.frame_id = std::string(image->header.frame_id);
        stream.is_depth = image->format.find("compressedDepth") != std::string_view::npos ||
                          stream.topic.ends_with("/compressedDepth");
        stream.depth_scale = RosDepthScale(image->format);
        stream.depth_in_m = IsRosDepthInMetres(image->format);
        // compressed_image_transport puts the encoding first: "mono8; jpeg compressed ".
        const std::string_view encoding = image->format.substr(0, image->format.find(';'));
        stream.is_grey = IsGreyEncoding(encoding);
        const std::string format = Printable(image->format, kQuotedBytes);
        if (!stream.is_depth && IsDepthEncoding(encoding)) {
            stream.unread = fmt::format(
                "images in the format '{}' are not read (depth only as compressedDepth)", format);
            return;
        }
        stream.unread = fmt::format("its first images cannot be decoded (format '{}')", format);
        if (stream.is_depth && DecodeRosDepth(*image, depth_).ok()) {
            stream.width = depth_.width();
            stream.height = depth_.height();
        } else if (!stream.is_depth && DecodeRosColour(*image, colour_).ok()) {
            stream.width = colour_.width();
            stream.height = colour_.height();
        }
    }

    void TakeCamera(const MessageTopic& topic, const MessagePlace& place) {
        if (contents_.cameras.contains(topic.name) || !file_.Read(place, message_).ok()) return;
        if (const auto info = ParseCameraInfo(topic.serialisation, message_);
            info && HasCalibration(*info))
            contents_.cameras.emplace(topic.name, CameraOf(*info));
    }
    void TakeTransforms(const MessageTopic& topic, const MessagePlace& place) {
        if (!file_.Read(place, message_).ok()) return;
        const bool is_static = topic.name.ends_with("tf_static");
        for (const RosTransform& transform : ParseTransforms(topic.serialisation, message_))
            contents_.transforms.Add(transform, is_static);
    }
    void TakeExtrinsics(const MessageTopic& topic, const MessagePlace& place) {
        const std::size_t end = topic.name.find("/tf/");
        if (end == std::string::npos || !file_.Read(place, message_).ok()) return;
        if (const auto T_stream_device = ParseTransform(topic.serialisation, message_))
            contents_.realsense_extrinsics.try_emplace(topic.name.substr(0, end), *T_stream_device);
    }

    MessageFile& file_;
    std::size_t number_;
    RosContents& contents_;
    std::vector<std::uint8_t> message_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
};

bool HasNoStamps(const RosStream& stream) {
    return std::ranges::all_of(stream.images,
                               [](const RosImagePlace& image) { return image.stamp_s == 0; });
}

// A /clock that stands still or is slower than the images, for example.
bool MostStampsRepeat(const RosStream& stream) {
    std::set<double> stamps_s;
    for (const RosImagePlace& image : stream.images) stamps_s.insert(image.stamp_s);
    return 2 * stamps_s.size() < stream.images.size();
}

void StampByReceipt(RosStream& stream, std::vector<std::string>& warnings) {
    if (!HasNoStamps(stream) && !MostStampsRepeat(stream)) return;
    for (RosImagePlace& image : stream.images) image.stamp_s = image.place.received_s;
    warnings.push_back(fmt::format(
        "{}: the stamps in its headers are zero or repeat: the times of recording are used",
        stream.topic));
}

void SortByStamp(RosStream& stream, std::vector<std::string>& notes) {
    const std::size_t all = stream.images.size();
    std::ranges::stable_sort(stream.images, {}, &RosImagePlace::stamp_s);
    const auto repeated = std::unique(
        stream.images.begin(), stream.images.end(),
        [](const RosImagePlace& a, const RosImagePlace& b) { return a.stamp_s == b.stamp_s; });
    stream.images.erase(repeated, stream.images.end());
    if (stream.images.size() < all)
        notes.push_back(
            fmt::format("{}: {} of {} images have the same stamp as another and are not used",
                        Printable(stream.topic), all - stream.images.size(), all));
}

}  // namespace

RosContents ScanRosFiles(std::span<const std::unique_ptr<MessageFile>> files) {
    RosContents contents;
    for (std::size_t i = 0; i < files.size(); ++i)
        if (const Status status = RosScan(*files[i], i, contents).Run(); !status.ok())
            contents.warnings.push_back(
                fmt::format("damaged or cut off: {}; what comes before is read", status.message()));
    for (const RosStream& stream : contents.streams)
        if (stream.width <= 0)
            contents.notes.push_back(Printable(stream.topic) + ": " + stream.unread);
    std::erase_if(contents.streams, [](const RosStream& stream) { return stream.width <= 0; });
    for (RosStream& stream : contents.streams) {
        StampByReceipt(stream, contents.warnings);
        SortByStamp(stream, contents.notes);
    }
    return contents;
}

}  // namespace tessera
