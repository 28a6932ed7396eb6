// Bags are written by Debian's rosbag (write_bag.py), ROS 2 recordings by ros2_writer.h.
#include "recordings/ros_recording.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "recordings/ros2_writer.h"
#include "recordings/ros_images_of.h"
#include "recordings/ros_recording_fixture.h"

namespace tessera {
namespace {

using namespace ros_test;

// T_colour_depth of the recordings: the colour camera is 15 mm to the right and turned about y.
Eigen::Isometry3d ExpectedTransform() {
    Eigen::Isometry3d T_depth_colour = Eigen::Isometry3d::Identity();
    T_depth_colour.linear() = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix();
    T_depth_colour.translation() = Eigen::Vector3d(0.015, 0, 0);
    return T_depth_colour.inverse();
}

void ExpectPlainRecording(const std::string& path) {
    RecordingResult recording = OpenRosRecording(path, kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectAllImages(*recording.value());
    const RecordingInfo& info = recording.value()->info();
    EXPECT_EQ(info.depth_camera.pinhole,
              (PinholeCamera{kDepthWidth, kDepthHeight, 60.5, 61.5, 31.25, 23.75}));
    EXPECT_EQ(info.colour_camera.pinhole,
              (PinholeCamera{kColourWidth, kColourHeight, 91, 92, 47.5, 35.25}));
    EXPECT_EQ(info.colour_camera.distortion, (LensDistortion{0.1, -0.05, 0.001, -0.002, 0.01}));
    EXPECT_TRUE(info.depth_camera.distortion.IsZero());
    EXPECT_TRUE(info.T_colour_depth.isApprox(ExpectedTransform(), 1e-12));
    EXPECT_EQ(info.depth_camera.depth_scale, 1000);
    EXPECT_FALSE(info.depth_in_m);
    EXPECT_TRUE(info.camera_known);
    EXPECT_TRUE(info.warnings.empty()) << info.warnings.front();
    EXPECT_NEAR(info.fps, 10, 1e-6);
    EXPECT_NEAR(info.pairs[1].colour_stamp_s, StampOf(1) + 0.004, 1e-9);
}

TEST(RosRecording, ReadsBagsInEachCompression) {
    TemporaryFolder folder;
    for (const char* compression : {"none", "bz2", "lz4"}) {
        SCOPED_TRACE(compression);
        const std::string path = folder.Path(compression) + ".bag";
        WRITE_BAG_OR_SKIP(path, "plain", compression);
        ExpectPlainRecording(path);
    }
}

TEST(RosRecording, ReadsMcapInEachCompression) {
    TemporaryFolder folder;
    for (const char* compression : {"", "lz4", "zstd"}) {
        SCOPED_TRACE(compression);
        const std::string path = folder.Path("recording.mcap");
        WriteRosFile(path, McapOf(PlainMessages(), compression));
        ExpectPlainRecording(path);
    }
}

TEST(RosRecording, ReadsDb3) {
    TemporaryFolder folder;
    WriteDb3(folder.Path("recording.db3"), PlainMessages());
    ExpectPlainRecording(folder.Path("recording.db3"));
}

TEST(RosRecording, ReadsDepthCompressedAsRvl) {
    TemporaryFolder folder;
    WriteDb3(folder.Path("integers.db3"), RvlMessages(false));
    ExpectPlainRecording(folder.Path("integers.db3"));
    WriteDb3(folder.Path("floats.db3"), RvlMessages(true));
    RecordingResult recording = OpenRosRecording(folder.Path("floats.db3"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().depth_camera.depth_scale, 5000);
    EXPECT_TRUE(recording.value()->info().depth_in_m);
    Image<std::uint16_t> depth;
    ColourImage colour;
    ASSERT_TRUE(recording.value()->Load(2, depth, colour).ok());
    const Image<std::uint16_t> stored = DepthOf(2);
    ASSERT_EQ(depth.size(), stored.size());
    for (std::size_t i = 0; i < depth.size(); ++i)
        ASSERT_NEAR(depth.data()[i], 5000 * kInverseA / (stored.data()[i] - kInverseB), 0.51);
}

TEST(RosRecording, ReadsTheFilesOfAFolderInOrder) {
    TemporaryFolder folder;
    const std::vector<Message> messages = PlainMessages();
    const auto middle = messages.begin() + 7;
    WriteRosFile(folder.Path("r_9.mcap"), McapOf({messages.begin(), middle}, "zstd"));
    WriteRosFile(folder.Path("r_10.mcap"), McapOf({middle, messages.end()}, "zstd"));
    EXPECT_TRUE(IsRosFolder(folder.path()));
    ExpectPlainRecording(folder.path());
}

TEST(RosRecording, DepthInMetresIsRegisteredWhereTheFramesAreOne) {
    TemporaryFolder folder;
    WRITE_BAG_OR_SKIP(folder.Path("a.bag"), "float", "none");
    RecordingResult recording = OpenRosRecording(folder.Path("a.bag"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    const RecordingInfo& info = recording.value()->info();
    EXPECT_TRUE(info.T_colour_depth.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_EQ(info.colour_camera.pinhole, info.depth_camera.pinhole);
    EXPECT_EQ(info.depth_camera.depth_scale, 5000);
    EXPECT_TRUE(info.depth_in_m);
    Image<std::uint16_t> depth;
    ColourImage colour;
    ASSERT_TRUE(recording.value()->Load(3, depth, colour).ok());
    const Image<std::uint16_t> expected = DepthOf(3);
    for (std::size_t i = 0; i < depth.size(); ++i)
        ASSERT_EQ(depth.data()[i], 5 * expected.data()[i]);
}

TEST(RosRecording, ReadsCompressedImagesAndRectifiedCameras) {
    TemporaryFolder folder;
    WRITE_BAG_OR_SKIP(folder.Path("a.bag"), "compressed", "lz4");
    RecordingResult recording = OpenRosRecording(folder.Path("a.bag"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectAllImages(*recording.value());
    // "rect": the projection matrix counts, not the raw camera.
    EXPECT_EQ(recording.value()->info().depth_camera.pinhole,
              (PinholeCamera{kDepthWidth, kDepthHeight, 59.5, 60.5, 31.25, 23.75}));
}

TEST(RosRecording, ReadsRealsenseBags) {
    TemporaryFolder folder;
    WRITE_BAG_OR_SKIP(folder.Path("a.bag"), "realsense", "lz4");
    RecordingResult recording = OpenRosRecording(folder.Path("a.bag"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectAllImages(*recording.value());
    const RecordingInfo& info = recording.value()->info();
    EXPECT_NEAR(info.depth_camera.depth_scale, 2000, 1e-3);
    // From the device to the colour camera, after the way back from the depth camera.
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
    T_colour_depth.linear() = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix();
    T_colour_depth.translation() =
        Eigen::Vector3d(0.6, 0, 0) - T_colour_depth.linear() * Eigen::Vector3d(0.5, 0, 0);
    EXPECT_TRUE(info.T_colour_depth.isApprox(T_colour_depth, 1e-12));
    // The inverse model's k1 has about the opposite sign.
    EXPECT_NEAR(info.colour_camera.distortion.k1, -0.1, 0.03);
    EXPECT_TRUE(info.warnings.empty()) << info.warnings.front();
}

TEST(RosRecording, CountsDepthImagesWithoutColour) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    messages.pop_back();  // the last colour image
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectAllImages(*recording.value(), kFrames - 1);
    EXPECT_TRUE(recording.value()->info().notes.back().starts_with(
        "1 of 5 depth images have no colour image near enough in time"));
}

TEST(RosRecording, SaysThatThereIsNoColour) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    for (const bool has_colour : {true, false}) {
        WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
        RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
        ASSERT_TRUE(recording.ok()) << recording.message();
        EXPECT_EQ(recording.value()->info().has_colour, has_colour);
        std::erase_if(messages, [](const Message& m) { return m.topic == "/cam/color/image_raw"; });
    }
}

// Each depth image gets the colour image before it, whose stamp is 96 ms earlier.
TEST(RosRecording, PairsWhatWasTakenAtTheSameTime) {
    TemporaryFolder folder;
    WriteRosFile(folder.Path("a.mcap"), McapOf(PlainMessages(), ""));
    const RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s, 0.095);
    ASSERT_TRUE(recording.ok()) << recording.message();
    const RecordedPair& first = recording.value()->info().pairs[0];
    EXPECT_NEAR(first.depth_stamp_s, StampOf(1), 1e-9);
    EXPECT_NEAR(first.colour_stamp_s, StampOf(0) + 0.004, 1e-9);
}

}  // namespace
}  // namespace tessera
