// ROS recordings whose topics, cameras, stamps or transforms are not what they seem.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/printable.h"
#include "io/jpeg_encoder.h"
#include "io/nominal_camera.h"
#include "io/png_encoder.h"
#include "io/temporary_folder.h"
#include "recordings/recording_source.h"
#include "recordings/ros2_writer.h"
#include "recordings/ros_images_of.h"
#include "recordings/ros_recording.h"
#include "recordings/ros_recording_fixture.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

using namespace ros_test;

using Notes = std::vector<std::string>;

const std::string kPlainChoice =
    "depth from /cam/depth/image_raw, colour from /cam/color/image_raw";
// PlainMessages: the transforms, the two CameraInfos, then depth and colour of each frame.
constexpr std::size_t kDepthInfo = 1, kColourInfo = 2, kFirstDepth = 3, kFirstColour = 4;

RecordingResult Open(const std::vector<Message>& messages, const RosTopics& wanted = {}) {
    TemporaryFolder folder;
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    return OpenRosRecording(folder.Path("a.mcap"), kRosGap_s, 0, wanted);
}

RecordingInfo InfoOf(const std::vector<Message>& messages, const RosTopics& wanted = {}) {
    const RecordingResult recording = Open(messages, wanted);
    EXPECT_TRUE(recording.ok()) << recording.message();
    return recording.ok() ? recording.value()->info() : RecordingInfo();
}

std::string TextOf(const std::vector<std::uint8_t>& file) { return {file.begin(), file.end()}; }

std::string JpegOf(const ColourImage& colour) {
    std::vector<std::uint8_t> file;
    EXPECT_TRUE(EncodeJpeg(colour, kFineJpegQuality, file).ok());
    return TextOf(file);
}

std::string PngOf(const Image<std::uint16_t>& depth) {
    std::vector<std::uint8_t> file;
    PngEncoder().EncodeDepth(depth, file);
    return TextOf(file);
}

std::string PngOf(const ColourImage& colour) {
    std::vector<std::uint8_t> file;
    PngEncoder().EncodeColour(colour, file);
    return TextOf(file);
}

Message Compressed(const std::string& topic, int frame, const std::string& frame_id,
                   const std::string& format, const std::string& data) {
    return {topic, "sensor_msgs/msg/CompressedImage", 2 * frame + 1,
            CompressedImageOf(frame, frame_id, format, data)};
}

// With colour as CompressedImage: `data` in the first `damaged` frames, then PNG.
std::vector<Message> WithCompressedColour(const std::string& format, int damaged,
                                          const std::string& data) {
    std::vector<Message> messages = PlainMessages();
    int frame = 0;
    for (std::size_t i = kFirstColour; i < messages.size(); i += 2, ++frame)
        messages[i] = Compressed("/cam/color/image_raw/compressed", frame, "colour_optical", format,
                                 frame < damaged ? data : PngOf(ColourOf(frame)));
    return messages;
}

void CopyStamp(const Message& from, Message& to) {
    constexpr std::size_t kStampAt = 4, kStampBytes = 8;
    to.data.replace(kStampAt, kStampBytes, from.data, kStampAt, kStampBytes);
}

// It is in the depth's frame and has the longest name in common.
TEST(RosTopics, TheCompressedTransportOfDepthIsNoColour) {
    const std::string topic = "/cam/depth/image_raw/compressed";
    for (const std::string format : {"16UC1; png compressed ", "16UC1; jpeg compressed ",
                                     "32FC1; png compressed ", "mono16; png compressed "}) {
        SCOPED_TRACE(format);
        std::vector<Message> messages = PlainMessages();
        const bool jpeg = format.find("jpeg") != std::string::npos;
        for (int i = 0; i < kFrames; ++i)
            messages.push_back(Compressed(topic, i, "depth_optical", format,
                                          jpeg ? JpegOf(ColourOf(i)) : PngOf(DepthOf(i))));
        EXPECT_EQ(InfoOf(messages).notes, (Notes{topic + ": images in the format '" + format +
                                                     "' are not read (depth only as "
                                                     "compressedDepth)",
                                                 kPlainChoice}));
    }
}

TEST(RosTopics, CompressedGreyComesAfterColour) {
    const std::string topic = "/cam/depth/left/compressed";
    std::vector<Message> messages = PlainMessages();
    for (int i = 0; i < kFrames; ++i)
        messages.push_back(
            Compressed(topic, i, "depth_optical", "mono8; jpeg compressed ", JpegOf(ColourOf(i))));
    const std::string unused =
        "also holds images, not used: " + topic + " (source.depth_topic, source.colour_topic)";
    EXPECT_EQ(InfoOf(messages).notes, (Notes{unused, kPlainChoice}));
}

TEST(RosTopics, InfraredOf16BitsIsDepthOnlyOnRequest) {
    for (const std::string topic :
         {"/k4a/ir/image_raw", "/ir/image_raw", "/camera/left_ir/image_raw", "/kinect2/sd/image_ir",
          "/kinect2/sd/image_ir_rect", "/camera/infra1/image_rect_raw"}) {
        SCOPED_TRACE(topic);
        std::vector<Message> messages = PlainMessages();
        messages.erase(messages.end() - 2);  // depth has one image less
        for (int i = 0; i < kFrames; ++i)
            messages.push_back({topic, "sensor_msgs/msg/Image", 2 * i + 1,
                                DepthImageOf(i, "depth_optical", "mono16")});
        EXPECT_EQ(InfoOf(messages).notes.back(), kPlainChoice);
        EXPECT_EQ(InfoOf(messages, {topic, ""}).notes.back(),
                  "depth from " + topic + ", colour from /cam/color/image_raw");
    }
}

TEST(RosTopics, ACameraInfoOfZerosIsNone) {
    const TempFolder folder;  // a TemporaryFolder would go with that of Open
    const std::string file = folder / "camera.yaml";
    WriteRosFile(file, "width: 64\nheight: 48\nfx: 41\nfy: 42\ncx: 32\ncy: 24\n");
    std::vector<Message> zeros = PlainMessages(), no_size = zeros;
    constexpr std::size_t kMatrixBytes = (9 + 9 + 12) * sizeof(double);
    for (const std::size_t info : {kDepthInfo, kColourInfo}) {
        std::string& data = zeros[info].data;
        data.replace(data.size() - kMatrixBytes, kMatrixBytes, kMatrixBytes, '\0');
        no_size[info].data = CameraInfoOf(0, 0, 60.5, 31.25, 23.75, {}, "optical");
    }
    for (const std::vector<Message>& messages : {zeros, no_size}) {
        RecordingResult recording = Open(messages);
        ASSERT_TRUE(recording.ok()) << recording.message();
        const RecordingInfo& info = recording.value()->info();
        EXPECT_FALSE(info.camera_known);
        EXPECT_EQ(info.depth_camera.pinhole, NominalPinhole(kDepthWidth, kDepthHeight));
        EXPECT_EQ(info.notes[0],
                  "/cam/depth/image_raw: no camera_info, or only zeros in it: assuming a field of "
                  "view of 60 degrees");
        const auto source = MakeRecordingSource("/made/up", std::move(recording.value()), {}, file);
        ASSERT_TRUE(source.ok()) << source.message();
        EXPECT_EQ(source.value()->info().camera, (PinholeCamera{64, 48, 41, 42, 32, 24}));
        EXPECT_EQ(source.value()->info().notes,
                  (Notes{kPlainChoice, "the camera is that of " + file}));
    }
    zeros.push_back(PlainMessages()[kDepthInfo]);
    EXPECT_EQ(InfoOf(zeros).depth_camera.pinhole,
              (PinholeCamera{kDepthWidth, kDepthHeight, 60.5, 61.5, 31.25, 23.75}));
}

TEST(RosTopics, ImagesWithTheStampOfAnotherAreCounted) {
    std::vector<Message> messages = PlainMessages();
    messages.resize(kFirstDepth + 8);  // four frames
    CopyStamp(messages[kFirstDepth], messages[kFirstDepth + 2]);
    CopyStamp(messages[kFirstDepth + 4], messages[kFirstDepth + 6]);
    const RecordingInfo info = InfoOf(messages);
    EXPECT_EQ(info.pairs.size(), 2u);
    EXPECT_EQ(info.notes, (Notes{"/cam/depth/image_raw: 2 of 4 images have the same stamp as "
                                 "another and are not used",
                                 kPlainChoice}));
    EXPECT_TRUE(info.warnings.empty());
}

TEST(RosTopics, WhereMostStampsRepeatTheTimesOfRecordingCount) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    for (std::size_t i = kFirstDepth; i < messages.size(); ++i) {
        const std::size_t frame = (i - kFirstDepth) / 2;
        CopyStamp(messages[frame < 3 ? kFirstDepth : kFirstDepth + 6], messages[i]);
        messages[i].time_ns = 1'000'000'000'000 + 100'000'000 * static_cast<std::int64_t>(frame);
    }
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectAllImages(*recording.value());
    const char* repeats =
        "_raw: the stamps in its headers are zero or repeat: the times of recording are used";
    EXPECT_EQ(recording.value()->info().warnings,
              (Notes{std::string("/cam/depth/image") + repeats,
                     std::string("/cam/color/image") + repeats}));
}

TEST(RosTopics, ABadTransformDoesNotDiscardTheOthers) {
    const RecordingInfo plain = InfoOf(PlainMessages());
    std::vector<Message> messages = PlainMessages();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Link tool{"tool", {0, 0, 0, 0, 0, 0, 0}}, arm{"arm", {nan, 0, 0, 0, 0, 0, 1}};
    messages[0].data = TransformsOf({PlainLinks()[0], tool, arm, PlainLinks()[1]});
    const RecordingInfo info = InfoOf(messages);
    EXPECT_TRUE(info.T_colour_depth.isApprox(plain.T_colour_depth, 1e-12));
    EXPECT_TRUE(info.warnings.empty());
    messages[0].data.pop_back();
    EXPECT_EQ(InfoOf(messages).warnings.size(), 1u);  // the cameras are taken as one
}

TEST(RosTopics, NamesColourThatCannotBeDecoded) {
    for (const std::string& format : {std::string("rgb8; webp compressed"), std::string(70, '\n')})
        EXPECT_EQ(InfoOf(WithCompressedColour(format, kFrames, "RIFF")).notes,
                  (Notes{"/cam/color/image_raw/compressed: its first images cannot be decoded "
                         "(format '" +
                             Printable(format, kQuotedBytes) + "')",
                         "depth from /cam/depth/image_raw; no colour images"}));
}

TEST(RosTopics, TheFirstImagesMayBeDamaged) {
    TemporaryFolder folder;
    std::vector<Message> messages = WithCompressedColour("rgb8; png compressed ", 4, "x");
    messages[kFirstDepth].data.resize(100);
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().notes, Notes{kPlainChoice + "/compressed"});
    ASSERT_EQ(recording.value()->info().pairs.size(), static_cast<std::size_t>(kFrames));
    Image<std::uint16_t> depth;
    ColourImage colour;
    EXPECT_EQ(recording.value()->Load(0, depth, colour).message(),
              "/cam/depth/image_raw: a damaged message");
    EXPECT_FALSE(recording.value()->Load(3, depth, colour).ok());
    ASSERT_TRUE(recording.value()->Load(4, depth, colour).ok());
    EXPECT_TRUE(SamePixels(depth, DepthOf(4)));
    EXPECT_TRUE(SamePixels(colour, ColourOf(4)));
    for (std::size_t i = kFirstDepth; i < messages.size(); i += 2) messages[i].data.resize(100);
    EXPECT_TRUE(Open(messages).message().ends_with(
        "; /cam/depth/image_raw: its first messages are damaged"));
}

}  // namespace
}  // namespace tessera
