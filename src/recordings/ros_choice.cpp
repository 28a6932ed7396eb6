#include "recordings/ros_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <tuple>

#include "io/nominal_camera.h"
#include "recordings/phone_depth.h"

namespace tessera {
namespace {

// "/camera/depth" of "/camera/depth/image_raw/compressedDepth" and of "/camera/depth/image_raw";
// "/device_0/sensor_0/Depth_0" of "/device_0/sensor_0/Depth_0/image/data".
std::string RosPrefix(const RosStream& stream) {
    std::string name = stream.topic;
    const auto drop_last = [&name] { name.resize(std::min(name.rfind('/'), name.size())); };
    if (stream.is_compressed) drop_last();
    if (name.ends_with("/image/data")) drop_last();
    drop_last();
    return name;
}

std::string RosFrame(const RosStream& stream) {
    return stream.frame_id == kRealsenseFrame ? RosPrefix(stream) : stream.frame_id;
}

std::ptrdiff_t CommonPrefix(const std::string& a, const std::string& b) {
    return std::ranges::mismatch(a, b).in1 - a.begin();
}

// By the names of the cameras' drivers: "/camera/infra1/image_rect_raw", "/k4a/ir/image_raw",
// "/camera/left_ir/image_raw", "/kinect2/sd/image_ir_rect". Of 16 bits it looks like depth.
bool IsInfrared(const RosStream& stream) {
    const std::string name = stream.topic + "/";
    constexpr const char* kParts[] = {"/infra", "/Infrared", "/ir/", "_ir/", "/image_ir_"};
    return std::ranges::any_of(
        kParts, [&](const char* part) { return name.find(part) != std::string::npos; });
}

// The camera of a topic: the CameraInfo beside it, or else one of its frame.
const RosCamera* RosCameraOf(const RosContents& contents, const RosStream& stream) {
    const std::string prefix = RosPrefix(stream);
    for (const char* name : {"/camera_info", "/info/camera_info"})
        if (const auto found = contents.cameras.find(prefix + name);
            found != contents.cameras.end())
            return &found->second;
    if (stream.frame_id == kRealsenseFrame) return nullptr;
    for (const auto& [topic, camera] : contents.cameras)
        if (camera.frame_id == stream.frame_id) return &camera;
    return nullptr;
}

CameraCalibration CalibrationOf(const RosContents& contents, const RosStream& stream,
                                RecordingInfo& info) {
    CameraCalibration calibration;
    const RosCamera* camera = RosCameraOf(contents, stream);
    if (camera == nullptr) {
        info.camera_known = false;
        info.camera_from = kNominalCamera;
        info.notes.push_back(fmt::format("{}: {}, or only zeros in it: assuming {}", stream.topic,
                                         kNoCameraInfo, kNominalCamera));
        calibration.pinhole = NominalPinhole(stream.width, stream.height);
    } else if (stream.topic.find("rect") != std::string::npos) {
        calibration.pinhole = camera->rectified;
    } else {
        calibration = camera->raw;
        if (!camera->warning.empty())
            info.warnings.push_back(fmt::format("{}: {}", stream.topic, camera->warning));
    }
    if (calibration.pinhole.width > 0 && calibration.pinhole.height > 0)
        calibration.pinhole = ScaledTo(calibration.pinhole, stream.width, stream.height);
    calibration.depth_scale = stream.depth_scale;
    return calibration;
}

std::optional<Eigen::Isometry3d> BetweenStreams(const RosContents& contents,
                                                const RosStream& colour, const RosStream& depth) {
    if (RosFrame(colour) == RosFrame(depth)) return Eigen::Isometry3d::Identity();
    if (depth.frame_id != kRealsenseFrame)
        return contents.transforms.Between(colour.frame_id, depth.frame_id);
    const auto T_colour_device = contents.realsense_extrinsics.find(RosPrefix(colour));
    const auto T_depth_device = contents.realsense_extrinsics.find(RosPrefix(depth));
    if (T_colour_device == contents.realsense_extrinsics.end() ||
        T_depth_device == contents.realsense_extrinsics.end())
        return std::nullopt;
    return T_colour_device->second * T_depth_device->second.inverse();
}

// "a, b and 3 more".
std::string TopicList(const std::vector<std::string>& topics) {
    constexpr std::size_t kMostNamed = 20;
    const auto named = std::span(topics).first(std::min(topics.size(), kMostNamed));
    std::string text = fmt::format("{}", fmt::join(named, ", "));
    if (topics.size() > named.size())
        text += fmt::format(" and {} more", topics.size() - named.size());
    return text;
}

Status CheckTopic(const RosContents& contents, bool depth, const std::string& wanted) {
    if (wanted.empty()) return {};
    std::vector<std::string> topics;
    for (const RosStream& stream : contents.streams) {
        if (stream.is_depth != depth) continue;
        if (stream.topic == wanted) return {};
        topics.push_back(stream.topic);
    }
    const char* what = depth ? "depth" : "colour";
    return Status::Error(fmt::format("source.{}_topic: there are no {} images in {}; there are: {}",
                                     what, what, wanted,
                                     topics.empty() ? "none" : TopicList(topics)));
}

void NoteUnused(const RosContents& contents, const RosChoice& choice, RecordingInfo& info) {
    std::vector<std::string> unused;
    for (const RosStream& stream : contents.streams)
        if (&stream != choice.depth && &stream != choice.colour) unused.push_back(stream.topic);
    if (!unused.empty())
        info.notes.push_back(
            fmt::format("also holds images, not used: {} (source.depth_topic, "
                        "source.colour_topic)",
                        TopicList(unused)));
    info.notes.insert(info.notes.end(), contents.notes.begin(), contents.notes.end());
}

}  // namespace

Result<RosChoice> ChooseRosStreams(const RosContents& contents, const RosTopics& wanted) {
    for (const bool depth : {true, false})
        if (Status status = CheckTopic(contents, depth, depth ? wanted.depth : wanted.colour);
            !status.ok())
            return status;
    RosChoice choice;
    const auto colour_in_frame = [&](const RosStream& depth) {
        return std::ranges::any_of(contents.streams, [&](const RosStream& stream) {
            return !stream.is_depth && !IsInfrared(stream) && RosFrame(stream) == RosFrame(depth);
        });
    };
    const auto depth_rank = [&](const RosStream& stream) {
        return std::tuple(!IsInfrared(stream), colour_in_frame(stream), stream.images.size(),
                          !stream.is_compressed);
    };
    const auto colour_rank = [&](const RosStream& stream) {
        return std::tuple(!stream.is_grey, RosFrame(stream) == RosFrame(*choice.depth),
                          CommonPrefix(stream.topic, choice.depth->topic), stream.images.size(),
                          !stream.is_compressed);
    };
    for (const RosStream& stream : contents.streams)
        if (stream.is_depth && (wanted.depth.empty() || stream.topic == wanted.depth) &&
            (choice.depth == nullptr || depth_rank(stream) > depth_rank(*choice.depth)))
            choice.depth = &stream;
    if (choice.depth == nullptr) return choice;
    for (const RosStream& stream : contents.streams)
        if (!stream.is_depth &&
            (wanted.colour.empty() ? !IsInfrared(stream) : stream.topic == wanted.colour) &&
            (choice.colour == nullptr || colour_rank(stream) > colour_rank(*choice.colour)))
            choice.colour = &stream;
    return choice;
}

void FindRosCameras(const RosContents& contents, const RosChoice& choice, RecordingInfo& info) {
    info.depth_camera = CalibrationOf(contents, *choice.depth, info);
    info.depth_in_m = choice.depth->depth_in_m;
    NoteUnused(contents, choice, info);
    if (choice.colour == nullptr) {
        info.colour_camera = info.depth_camera;
        info.has_colour = false;
        info.notes.push_back(fmt::format("depth from {}; no colour images", choice.depth->topic));
        return;
    }
    info.colour_camera = CalibrationOf(contents, *choice.colour, info);
    info.notes.push_back(
        fmt::format("depth from {}, colour from {}", choice.depth->topic, choice.colour->topic));
    if (const auto T = BetweenStreams(contents, *choice.colour, *choice.depth))
        info.T_colour_depth = *T;
    else
        info.warnings.push_back(
            fmt::format("how the cameras {} and {} stand to each other is not in the recording: "
                        "they are taken as one",
                        RosFrame(*choice.depth), RosFrame(*choice.colour)));
}

}  // namespace tessera
