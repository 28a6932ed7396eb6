// Parts of the format that ffmpeg does not write, as bytes by hand. mkv_recording_test.cpp reads
// whole files of ffmpeg's.
#include "recordings/mkv_index.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"
#include "recordings/mkv_elements.h"

namespace tessera {
namespace {

std::string MkvBigEndian(std::uint64_t value, int bytes) {
    std::string text;
    while (bytes-- > 0) text += static_cast<char>(value >> (8 * bytes) & 0xff);
    return text;
}

// An element with a size of eight bytes, as k4arecorder writes for what may grow, or of four.
std::string MkvElementOf(MkvId id, const std::string& content, bool known_size = true) {
    const auto number = static_cast<std::uint32_t>(id);
    const int id_bytes = number > 0xffffff ? 4 : number > 0xffff ? 3 : number > 0xff ? 2 : 1;
    const std::string head = MkvBigEndian(number, id_bytes);
    if (!known_size) return head + '\xff' + content;
    if (content.size() % 2 == 0)
        return head + MkvBigEndian(content.size() | std::uint64_t{1} << 56, 8) + content;
    return head + MkvBigEndian(content.size() | std::uint64_t{1} << 28, 4) + content;
}

std::string MkvVideoTrack(int number, const std::string& name, const std::string& more = "") {
    return MkvElementOf(MkvId::kTrackEntry,
                        MkvElementOf(MkvId::kTrackNumber, MkvBigEndian(number, 1)) +
                            MkvElementOf(MkvId::kTrackUid, MkvBigEndian(70 + number, 8)) +
                            MkvElementOf(MkvId::kTrackType, "\1") +
                            MkvElementOf(MkvId::kName, name) +
                            MkvElementOf(MkvId::kCodecId, "V_MJPEG") + more);
}

std::string MkvBlockOf(int track, int ticks, const std::string& image, char flags = 0) {
    return std::string{static_cast<char>(0x80 | track), static_cast<char>(ticks >> 8),
                       static_cast<char>(ticks & 0xff), flags} +
           image;
}

std::string MkvClusterOf(std::uint64_t ticks, const std::string& blocks, bool known_size = true) {
    return MkvElementOf(MkvId::kCluster,
                        MkvElementOf(MkvId::kCrc32, "abcd") +
                            MkvElementOf(MkvId::kTimestamp, MkvBigEndian(ticks, 4)) + blocks,
                        known_size);
}

class MkvIndexes : public ::testing::Test {
  protected:
    // The tracks 1 and 2 are video with a microsecond's tick; 3 is something else.
    MkvIndex Read(const std::string& rest, bool known_size = true) {
        const std::string info =
            MkvElementOf(MkvId::kInfo, MkvElementOf(MkvId::kTimestampScale, MkvBigEndian(1000, 3)));
        const std::string tracks = MkvElementOf(
            MkvId::kTracks,
            MkvVideoTrack(1, "COLOR") +
                MkvVideoTrack(2, "DEPTH",
                              MkvElementOf(MkvId::kDefaultDuration, MkvBigEndian(200'000'000, 4)) +
                                  MkvElementOf(MkvId::kVideo,
                                               MkvElementOf(MkvId::kPixelWidth, "\x02\x80") +
                                                   MkvElementOf(MkvId::kPixelHeight, "\x01"))) +
                MkvElementOf(MkvId::kTrackEntry, MkvElementOf(MkvId::kTrackNumber, "\3")));
        bytes =
            MkvElementOf(MkvId::kEbml, "") +
            MkvElementOf(MkvId::kSegment,
                         MkvElementOf(MkvId::kVoid, std::string(900, 'x')) + info + tracks + rest,
                         known_size);
        folder.WriteText("a.mkv", bytes);
        const auto file = InputFile::Open(folder.Path("a.mkv"));
        auto index = ReadMkvIndex(file.value());
        EXPECT_TRUE(index.ok()) << index.message();
        return index.value();
    }
    std::string ImageOf(const MkvBlock& block) { return bytes.substr(block.offset, block.bytes); }

    TemporaryFolder folder;
    std::string bytes;
};

TEST_F(MkvIndexes, ManyBlocksInACluster) {
    const std::string samples = MkvElementOf(
        MkvId::kBlockGroup, MkvElementOf(MkvId::kBlock, MkvBlockOf(3, 5, "imu imu", 0x04)) +
                                MkvElementOf(MkvId{0x9b}, "\x20"));
    const std::string group = MkvElementOf(
        MkvId::kBlockGroup, MkvElementOf(MkvId::kBlock, MkvBlockOf(1, 31000, "grouped")));
    const MkvIndex index = Read(
        MkvClusterOf(1'000'000,
                     MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(2, -4, "first")) + samples +
                         MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(1, 0, "one")) + group) +
        MkvClusterOf(2'000'000, MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(2, 7, "second"))) +
        MkvElementOf(MkvId::kCues, "not read"));
    EXPECT_TRUE(index.warnings.empty()) << index.warnings[0];
    ASSERT_EQ(index.tracks.size(), 3u);
    const MkvTrack &colour = index.tracks[0], &depth = index.tracks[1];
    EXPECT_EQ(depth.name, "DEPTH");
    EXPECT_EQ(depth.number, 2u);
    EXPECT_EQ(depth.uid, 72u);
    EXPECT_EQ(depth.width, 640u);
    EXPECT_EQ(depth.height, 1u);
    EXPECT_DOUBLE_EQ(depth.fps, 5);
    EXPECT_EQ(depth.format, "MJPG");
    ASSERT_EQ(depth.blocks.size(), 2u);
    EXPECT_EQ(depth.blocks[0].stamp_ns, 999'996'000);
    EXPECT_EQ(ImageOf(depth.blocks[0]), "first");
    EXPECT_EQ(depth.blocks[1].stamp_ns, 2'000'007'000);
    EXPECT_EQ(ImageOf(depth.blocks[1]), "second");
    ASSERT_EQ(colour.blocks.size(), 2u);
    EXPECT_EQ(ImageOf(colour.blocks[0]), "one");
    EXPECT_EQ(colour.blocks[1].stamp_ns, 1'031'000'000);
    EXPECT_EQ(ImageOf(colour.blocks[1]), "grouped");
    EXPECT_TRUE(index.tracks[2].blocks.empty());
}

TEST_F(MkvIndexes, TagsAndAttachments) {
    const auto tag = [](const std::string& name, const std::string& text) {
        return MkvElementOf(
            MkvId::kTag,
            MkvElementOf(MkvId{0x63c0}, "") +
                MkvElementOf(MkvId::kSimpleTag, MkvElementOf(MkvId::kTagName, name) +
                                                    MkvElementOf(MkvId::kTagString, text)));
    };
    const std::string file =
        MkvElementOf(MkvId::kFileName, "calibration.json") + MkvElementOf(MkvId::kFileData, "{ }");
    const MkvIndex index =
        Read(MkvElementOf(MkvId::kAttachments, MkvElementOf(MkvId::kAttachedFile, file)) +
             MkvElementOf(MkvId::kTags, tag("A", "1") + tag("B", "2") + tag("A", "3")));
    EXPECT_TRUE(index.warnings.empty());
    EXPECT_EQ(index.tags, (std::map<std::string, std::string>{{"A", "1"}, {"B", "2"}}));
    ASSERT_EQ(index.attachments.size(), 1u);
    EXPECT_EQ(index.attachments[0].name, "calibration.json");
    EXPECT_EQ(bytes.substr(index.attachments[0].offset, index.attachments[0].bytes), "{ }");
}

// A recorder that was stopped leaves clusters of a size that is not known, or a wrong one above.
TEST_F(MkvIndexes, SizesMayBeUnknown) {
    const auto cluster = [](int ticks, bool known_size) {
        return MkvClusterOf(ticks, MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(1, 0, "image")),
                            known_size);
    };
    for (const bool known : {true, false}) {
        const MkvIndex index =
            Read(cluster(1, false) + cluster(2, known) + cluster(3, false), known);
        EXPECT_TRUE(index.warnings.empty());
        EXPECT_EQ(index.tracks[0].blocks.size(), 3u);
    }
}

TEST_F(MkvIndexes, WhatCannotBeReadIsSaid) {
    const auto block = [](int ticks, char flags = 0) {
        return MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(1, ticks, "image", flags));
    };
    const auto warning = [&](const std::string& rest, std::size_t count) {
        const MkvIndex index = Read(rest);
        EXPECT_EQ(index.tracks.at(0).blocks.size(), count);
        EXPECT_EQ(index.warnings.size(), 1u);
        return index.warnings.empty() ? "" : index.warnings[0];
    };
    EXPECT_EQ(warning(MkvClusterOf(0, block(9) + block(5) + block(9)), 2),
              "1 images of the track COLOR repeat a time stamp and are dropped");
    EXPECT_EQ(warning(MkvClusterOf(0, block(1) + block(2, 0x06)), 1),
              "1 blocks of several images each are not read");
    // A block outside a cluster, and one that is longer than its cluster.
    EXPECT_NE(warning(block(1) + MkvClusterOf(0, block(2)), 1).find("in 1 place,"),
              std::string::npos);
    std::string longer = MkvClusterOf(0, block(1) + block(2));
    longer.replace(longer.rfind("image") - 5, 1, 1, '\x30');
    EXPECT_NE(warning(longer + MkvClusterOf(9, block(3)), 2).find("in 1 place,"),
              std::string::npos);
    EXPECT_NE(warning(MkvClusterOf(0, block(1)) + "garbage", 1).find("cut off"), std::string::npos);
    std::string large(std::size_t{17} << 20, '\0');
    EXPECT_EQ(warning(MkvElementOf(MkvId::kAttachedFile, large), 0),
              "an attachment is too large and is not read");
}

// The stamp would be beyond 64 bits.
TEST_F(MkvIndexes, TheUnitOfStampsDoesNotChangeWithinACluster) {
    const auto info = [](std::uint64_t tick_ns) {
        return MkvElementOf(MkvId::kInfo,
                            MkvElementOf(MkvId::kTimestampScale, MkvBigEndian(tick_ns, 4)));
    };
    const MkvIndex index =
        Read(info(1) +
             MkvElementOf(MkvId::kCluster,
                          MkvElementOf(MkvId::kTimestamp, MkvBigEndian(std::uint64_t{1} << 50, 8)) +
                              info(1'000'000'000) +
                              MkvElementOf(MkvId::kSimpleBlock, MkvBlockOf(1, 0, "image"))));
    EXPECT_TRUE(index.tracks[0].blocks.empty());
    EXPECT_EQ(index.warnings.size(), 1u);
}

TEST_F(MkvIndexes, ManyDamagesEndTheReading) {
    std::string damaged;
    for (int i = 0; i < 2000; ++i) damaged += MkvClusterOf(i, "") + '\0';
    const MkvIndex index = Read(damaged);
    ASSERT_EQ(index.warnings.size(), 2u);
    EXPECT_NE(index.warnings[1].find("in 1000 places"), std::string::npos);
}

TEST(MkvElements, NumbersAndHeads) {
    const auto head = [](const std::string& bytes) {
        return ReadMkvHead({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    };
    const auto read = head({0x1f, 0x43, '\xb6', 0x75, 0x40, 2});
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->id, MkvId::kCluster);
    EXPECT_EQ(read->head_bytes, 6u);
    EXPECT_EQ(read->bytes, 2u);
    EXPECT_FALSE(read->unknown_size);
    EXPECT_EQ(head({'\xa3', 1, 0, 0, 0, 0, 0, 1, 0})->bytes, 256u);
    EXPECT_TRUE(head({'\xa3', 0x7f, '\xff'})->unknown_size);
    EXPECT_FALSE(head({'\xa3', 0x7f, '\xfe'})->unknown_size);
    EXPECT_FALSE(head("").has_value());
    EXPECT_FALSE(head({'\xa3'}).has_value());
    EXPECT_FALSE(head({'\xa3', 0x40}).has_value());
    EXPECT_FALSE(head({'\xa3', 0, 0, 0, 0, 0, 0, 0, 0, 0}).has_value());
    EXPECT_FALSE(head({0x08, 0, 0, 0, 0, 0, 0}).has_value());
}

}  // namespace
}  // namespace tessera
