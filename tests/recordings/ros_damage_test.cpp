// ROS recordings that are cut off, damaged or lack something.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "recordings/ros2_writer.h"
#include "recordings/ros_images_of.h"
#include "recordings/ros_recording.h"
#include "recordings/ros_recording_fixture.h"

namespace tessera {
namespace {

using namespace ros_test;

std::string RosFileContent(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RosRecording, AFileThatIsCutOffIsReadUpToThere) {
    TemporaryFolder folder;
    const std::string whole = McapOf(PlainMessages(), "zstd");
    WriteRosFile(folder.Path("a.mcap"), whole.substr(0, whole.size() * 6 / 10));
    RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    const std::size_t pairs = recording.value()->info().pairs.size();
    EXPECT_GE(pairs, 1u);
    EXPECT_LT(pairs, static_cast<std::size_t>(kFrames));
    ExpectAllImages(*recording.value(), static_cast<int>(pairs));
    ASSERT_EQ(recording.value()->info().warnings.size(), 1u);
    EXPECT_TRUE(recording.value()->info().warnings[0].starts_with("damaged or cut off"));
}

TEST(RosRecording, SaysWhatIsMissing) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    std::erase_if(messages, [](const Message& m) { return m.topic == "/cam/depth/image_raw"; });
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    EXPECT_TRUE(OpenRosRecording(folder.Path("a.mcap"), kRosGap_s)
                    .message()
                    .starts_with(folder.Path("a.mcap") + ": no depth images"));
    WriteRosFile(folder.Path("b.mcap"), McapOf(PlainMessages(), ""));
    EXPECT_NE(OpenRosRecording(folder.Path("b.mcap"), 0.001).message().find("0.004 s apart"),
              std::string::npos);
    WriteRosFile(folder.Path("c.bag"), "#ROSBAG V1.2\n");
    EXPECT_NE(OpenRosRecording(folder.Path("c.bag"), kRosGap_s).message().find("rosbag fix"),
              std::string::npos);
    messages = PlainMessages();
    std::erase_if(messages, [](const Message& m) { return m.topic == "/tf_static"; });
    WriteRosFile(folder.Path("d.mcap"), McapOf(messages, ""));
    RecordingResult recording = OpenRosRecording(folder.Path("d.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ASSERT_EQ(recording.value()->info().warnings.size(), 1u);
    EXPECT_NE(recording.value()->info().warnings[0].find("taken as one"), std::string::npos);
}

TEST(RosRecording, WithoutStampsTheTimesOfRecordingCount) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    constexpr std::size_t kStampAt = 4, kStampBytes = 8;
    for (std::size_t i = 3; i < messages.size(); ++i) {
        messages[i].data.replace(kStampAt, kStampBytes, kStampBytes, '\0');
        const auto frame = static_cast<std::int64_t>(i - 3) / 2;
        messages[i].time_ns = 1'000'000'000'000 + 100'000'000 * frame;
    }
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    WriteDb3(folder.Path("a.db3"), messages);
    for (const char* name : {"a.mcap", "a.db3"}) {
        RecordingResult recording = OpenRosRecording(folder.Path(name), kRosGap_s);
        ASSERT_TRUE(recording.ok()) << recording.message();
        ExpectAllImages(*recording.value());
        ASSERT_EQ(recording.value()->info().warnings.size(), 2u);
        EXPECT_EQ(recording.value()->info().warnings[0],
                  "/cam/depth/image_raw: the stamps in its headers are zero or repeat: the times "
                  "of recording are used");
    }
}

TEST(RosRecording, WhatRosbag2HasCompressedIsRefusedWithAdvice) {
    TemporaryFolder folder;
    const std::string advice = "compressed by rosbag2: decompress it first: ros2 bag convert";
    std::vector<Message> messages = PlainMessages();
    for (Message& message : messages) message.data = "\x28\xb5\x2f\xfd" + message.data;
    WriteDb3(folder.Path("messages.db3"), messages);
    EXPECT_NE(OpenRosRecording(folder.Path("messages.db3"), kRosGap_s).message().find(advice),
              std::string::npos);
    TemporaryFolder whole;
    WriteRosFile(whole.Path("a_0.db3.zstd"), "x");
    ASSERT_TRUE(IsRosFolder(whole.path()));
    for (const std::string& path : {whole.path(), whole.Path("a_0.db3.zstd")})
        EXPECT_EQ(
            OpenRosRecording(path, kRosGap_s).message().find(whole.Path("a_0.db3.zstd: ") + advice),
            0u);
    EXPECT_FALSE(IsCompressedRosFile("a.zstd"));
}

TEST(RosRecording, NamesTheTopicsThatAreNotUsed) {
    TemporaryFolder folder;
    std::vector<Message> messages = PlainMessages();
    for (Message message : {messages[3], messages[4], messages[4]}) {
        message.topic = message.data.find("rgb8") == std::string::npos ? "/rear/depth/image_raw"
                                                                       : "/rear/color/image_raw";
        messages.push_back(message);
    }
    messages.back().topic = "/odd/image_raw";
    messages.back().data.replace(messages.back().data.find("rgb8"), 4, "abcd");
    WriteRosFile(folder.Path("a.mcap"), McapOf(messages, ""));
    RecordingResult recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s);
    ASSERT_TRUE(recording.ok()) << recording.message();
    const std::vector<std::string>& notes = recording.value()->info().notes;
    ASSERT_GE(notes.size(), 2u);
    EXPECT_EQ(notes[0],
              "also holds images, not used: /rear/depth/image_raw, /rear/color/image_raw "
              "(source.depth_topic, source.colour_topic)");
    EXPECT_EQ(notes[1], "/odd/image_raw: images in the encoding 'abcd' are not read");
    recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s, 0,
                                 {"/rear/depth/image_raw", "/rear/color/image_raw"});
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().pairs.size(), 1u);
    EXPECT_EQ(recording.value()->info().notes[0].find(
                  "also holds images, not used: /cam/depth/image_raw, /cam/color/image_raw ("),
              0u);
    recording = OpenRosRecording(folder.Path("a.mcap"), kRosGap_s, 0,
                                 {"/rear/depth/image_raw", "/cam/color/image_raw"});
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().notes[0].find(
                  "also holds images, not used: /cam/depth/image_raw, /rear/color/image_raw ("),
              0u);
    EXPECT_EQ(OpenRosRecording(folder.Path("a.mcap"), kRosGap_s, 0, {"/rear/color/image_raw", ""})
                  .message(),
              folder.Path("a.mcap") +
                  ": source.depth_topic: there are no depth images in /rear/color/image_raw; there "
                  "are: /cam/depth/image_raw, /rear/depth/image_raw");
}

// Opens the file and loads all images, with four bits turned over in the part from `first` on.
void ReadDamaged(const std::string& path, std::string content, std::size_t first, std::size_t bytes,
                 unsigned seed) {
    std::minstd_rand random(seed + 1);
    for (int i = 0; i < 4; ++i)
        content[first + random() % bytes] ^= static_cast<char>(1 << random() % 8);
    WriteRosFile(path, content);
    RecordingResult recording = OpenRosRecording(path, kRosGap_s);
    if (!recording.ok()) return;
    Image<std::uint16_t> depth;
    ColourImage colour;
    for (std::size_t i = 0; i < recording.value()->info().pairs.size(); ++i)
        (void)recording.value()->Load(i, depth, colour).ok();
}

// Damage gives an error, fewer images or other pixels, never a crash or a huge allocation. The
// first part has the heads of chunks, records and messages.
TEST(RosRecording, DamagedFilesAreNoDanger) {
    TemporaryFolder folder;
    for (const char* compression : {"", "lz4", "zstd"}) {
        const std::string good = McapOf(PlainMessages(), compression);
        for (unsigned seed = 0; seed < 60; ++seed)
            ReadDamaged(folder.Path("a.mcap"), good, 0, seed % 2 ? good.size() : 2000, seed);
    }
}

TEST(RosRecording, DamagedBagsAreNoDanger) {
    TemporaryFolder folder;
    const std::string path = folder.Path("a.bag");
    for (const char* compression : {"none", "bz2"}) {
        WRITE_BAG_OR_SKIP(path, "plain", compression);
        const std::string good = RosFileContent(path);
        for (unsigned seed = 0; seed < 60; ++seed)
            ReadDamaged(path, good, 13, seed % 2 ? good.size() - 13 : 5000, seed);
    }
}

}  // namespace
}  // namespace tessera
