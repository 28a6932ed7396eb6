#include "recordings/record3d_recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/temporary_folder.h"
#include "recordings/record3d_writer.h"

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes R3dBytesOf(const std::string& text) { return {text.begin(), text.end()}; }

class Record3d : public ::testing::Test {
  protected:
    void Frame(int number, int frame, LzfseBlock kind = LzfseBlock::kPacked) {
        AddRecord3dFrame(number, frame, kind, files);
    }
    // `rest`: what follows in the metadata.
    RecordingResult Open(const std::string& rest) {
        files["metadata"] = R3dBytesOf(kRecord3dCamera + rest + "}");
        return Reopen();
    }
    RecordingResult Reopen() {
        WriteZip(path, files);
        return OpenRecord3d(path);
    }
    void ExpectRefused(const RecordingResult& recording, const std::string& what) {
        ASSERT_FALSE(recording.ok()) << what;
        EXPECT_TRUE(recording.message().starts_with(path)) << recording.message();
        EXPECT_NE(recording.message().find(what), std::string::npos) << recording.message();
        EXPECT_NE(recording.message().find("export it"), std::string::npos) << recording.message();
    }
    void ExpectFrame(Recording& recording, std::size_t index, int frame, bool confidence = true) {
        ASSERT_EQ(recording.Load(index, depth, colour).message(), "");
        ASSERT_EQ(depth.width(), kRecord3dDepthWidth);
        ASSERT_EQ(depth.height(), kRecord3dDepthHeight);
        for (int i = 0; i < kRecord3dPixels; ++i) {
            const bool kept = i >= 5 && (!confidence || Record3dConfidenceOf(i) > 0);
            const long expected = kept ? std::lround(1e4 * Record3dDepthOf(frame, i)) : 0;
            EXPECT_EQ(depth(i % kRecord3dDepthWidth, i / kRecord3dDepthWidth), expected) << i;
        }
        ASSERT_EQ(colour.width(), kRecord3dWidth);
        ASSERT_EQ(colour.height(), kRecord3dHeight);
        for (std::size_t i = 0; i < colour.size(); ++i) {
            EXPECT_NEAR(colour.data()[i].r, Record3dColourOf(frame).r, 3);
            EXPECT_NEAR(colour.data()[i].b, Record3dColourOf(frame).b, 3);
        }
    }
    static std::vector<double> Stamps(const RecordingInfo& info) {
        std::vector<double> stamps_s;
        for (const RecordedPair& pair : info.pairs) {
            EXPECT_EQ(pair.depth_stamp_s, pair.colour_stamp_s);
            stamps_s.push_back(pair.depth_stamp_s);
        }
        return stamps_s;
    }

    TemporaryFolder folder;
    const std::string path = folder.Path("a.r3d");
    ZipFiles files;
    Image<std::uint16_t> depth;
    ColourImage colour;
};

TEST_F(Record3d, GivesAllPixelsInTheOrderOfNumbers) {
    Frame(0, 0, LzfseBlock::kPacked);
    Frame(2, 1, LzfseBlock::kLzvn);
    Frame(10, 2, LzfseBlock::kRaw);
    Frame(100, 3, LzfseBlock::kWide);
    for (const char* other : {"icon", "sound.m4a", "rgbd/", "rgbd/x.jpg", "rgbd/5.txt", "5.jpg"})
        files[other] = R3dBytesOf("other");
    const auto recording =
        Open(kRecord3dDepthSize + R"(, "frameTimestamps": [0.5, 0.6, 0.8, 0.9])");
    ASSERT_TRUE(recording.ok()) << recording.message();
    const RecordingInfo& info = recording.value()->info();
    EXPECT_EQ(info.kind, "Record3D recording");
    EXPECT_EQ(info.notes, std::vector<std::string>{"depth of confidence 0 is left out"});
    EXPECT_TRUE(info.warnings.empty());
    EXPECT_TRUE(info.camera_known);
    EXPECT_TRUE(info.T_colour_depth.matrix().isIdentity());
    EXPECT_EQ(Stamps(info), (std::vector<double>{0.5, 0.6, 0.8, 0.9}));
    EXPECT_EQ(info.colour_camera.pinhole, (PinholeCamera{48, 64, 50, 52, 23, 33}));
    EXPECT_EQ(info.depth_camera.pinhole, (PinholeCamera{12, 16, 12.5, 13, 5.375, 7.875}));
    EXPECT_EQ(info.depth_camera.depth_scale, 10000);
    EXPECT_TRUE(info.depth_in_m);
    for (const int frame : {3, 0, 2, 1})
        ExpectFrame(*recording.value(), static_cast<std::size_t>(frame), frame);
}

TEST_F(Record3d, SizesThatTheMetadataLacksComeFromTheImages) {
    Frame(0, 0);
    const PinholeCamera expected{12, 16, 12.5, 13, 5.375, 7.875};
    for (const char* size : {"", R"(, "dw": 16, "dh": 11)", R"(, "dw": 12)"}) {
        const auto recording = Open(size);
        ASSERT_TRUE(recording.ok()) << recording.message();
        EXPECT_EQ(recording.value()->info().depth_camera.pinhole, expected);
        ExpectFrame(*recording.value(), 0, 0);
    }
    const auto turned = Open(R"(, "dw": 16, "dh": 12)");
    ASSERT_TRUE(turned.ok()) << turned.message();
    EXPECT_EQ(turned.value()->info().depth_camera.pinhole.width, 16);
    // The camera is of larger images than are stored.
    files["rgbd/0.jpg"] = Record3dJpegOf(0, 24, 32);
    const auto recording = Open("");
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().depth_camera.pinhole, expected);
    EXPECT_EQ(recording.value()->info().colour_camera.pinhole,
              (PinholeCamera{24, 32, 25, 26, 11.25, 16.25}));
    files["rgbd/0.jpg"] = Record3dJpegOf(0, 64, 48);
    ExpectRefused(Open(""), "has images of 64 x 48 pixels, but a camera of 48 x 64 pixels");
    files["rgbd/0.jpg"] = Record3dJpegOf(0, kRecord3dWidth, kRecord3dHeight);
    for (const std::size_t pixels : {13u * 16u, 12u * 17u}) {
        files["rgbd/0.depth"] = LzfseOf(std::vector<float>(pixels, 1), LzfseBlock::kPacked);
        ExpectRefused(Open(kRecord3dDepthSize), "fit neither its metadata (12 x 16 pixels)");
    }
}

TEST_F(Record3d, FramesWithoutAnImageOrDepthAreLeftOut) {
    for (int i = 0; i < 5; ++i) Frame(i, i);
    files.erase("rgbd/0.jpg");
    files.erase("rgbd/3.depth");
    for (const char* ending : {".jpg", ".depth"}) files.erase(std::string("rgbd/1") + ending);
    // By number.
    auto recording = Open(R"(, "frameTimestamps": [1, 2, 3, 4, 6])");
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(Stamps(recording.value()->info()), (std::vector<double>{3, 6}));
    EXPECT_EQ(recording.value()->info().warnings,
              std::vector<std::string>{
                  "2 of 4 frames are left out: their image or their depth is missing"});
    ExpectFrame(*recording.value(), 0, 2);
    ExpectFrame(*recording.value(), 1, 4);
    recording = Open("");
    EXPECT_EQ(Stamps(recording.value()->info()), (std::vector<double>{0.1, 0.2}));
    // Time starts with the first frame.
    files.erase("rgbd/0.depth");
    recording = Open("");
    EXPECT_EQ(Stamps(recording.value()->info()), (std::vector<double>{0, 0.1}));
    files = {};
    ExpectRefused(Open(""), "has no frame with both rgbd/N.jpg and rgbd/N.depth");
}

TEST_F(Record3d, StampsThatDoNotFitAreReplaced) {
    for (int i = 0; i < 3; ++i) Frame(i, i);
    for (const char* stamps : {"1, 2", "1, 3, 2", "1, 2, 3, 4", "1, null, 2"}) {
        const auto recording = Open(std::string(R"(, "frameTimestamps": [)") + stamps + "]");
        EXPECT_EQ(Stamps(recording.value()->info()), (std::vector<double>{0, 0.05, 0.1})) << stamps;
        EXPECT_EQ(recording.value()->info().warnings,
                  std::vector<std::string>{"its time stamps do not fit its frames: 20 frames per "
                                           "second are assumed"});
    }
    const auto recording = Open("");
    EXPECT_EQ(recording.value()->info().notes[0],
              "it has no time stamps: 20 frames per second are assumed");
    EXPECT_NEAR(recording.value()->info().fps, 20, 1e-9);
    EXPECT_TRUE(recording.value()->info().warnings.empty());
}

TEST_F(Record3d, WithoutConfidenceAllDepthIsUsed) {
    for (const Bytes& none : {Bytes{}, R3dBytesOf("bvx$")}) {
        Frame(0, 0);
        files["rgbd/0.conf"] = none;
        Frame(1, 1);
        files.erase("rgbd/1.conf");
        const auto recording = Open(kRecord3dDepthSize);
        ASSERT_TRUE(recording.ok()) << recording.message();
        EXPECT_EQ(recording.value()->info().notes.size(), 1u);  // of stamps
        for (const int frame : {0, 1})
            ExpectFrame(*recording.value(), static_cast<std::size_t>(frame), frame, false);
    }
}

TEST_F(Record3d, DamagedFramesAreReportedAlone) {
    for (int i = 0; i < 6; ++i) Frame(i, i);
    files["rgbd/0.depth"] = R3dBytesOf("no LZFSE");
    files["rgbd/1.depth"] =
        LzfseOf(std::vector<float>(kRecord3dPixels + 1, 1), LzfseBlock::kPacked);
    files["rgbd/2.jpg"] = R3dBytesOf("no JPEG");
    files["rgbd/3.conf"].resize(20);
    files["rgbd/4.jpg"] = Record3dJpegOf(4, 24, 32);
    const auto recording = Open(kRecord3dDepthSize);
    ASSERT_TRUE(recording.ok()) << recording.message();
    const char* const expected[] = {"depth is damaged, or not of 12 x 16 pixels",
                                    "depth is damaged, or not of 12 x 16 pixels",
                                    "colour is damaged, or not of 48 x 64 pixels",
                                    "confidence is damaged, or not of 12 x 16 pixels",
                                    "colour is damaged, or not of 48 x 64 pixels"};
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(recording.value()->Load(i, depth, colour).message(), expected[i]);
    ExpectFrame(*recording.value(), 5, 5);
    files["rgbd/5.jpg"].resize(300);
    EXPECT_TRUE(Reopen().value()->Load(5, depth, colour).message().starts_with("colour is "));
    for (int i = 3; i < 6; ++i) files.erase("rgbd/" + std::to_string(i) + ".jpg");
    ExpectRefused(Open(kRecord3dDepthSize), "its first images are damaged, or no JPEG");
}

TEST_F(Record3d, WhatIsNoRecordingIsRefusedByName) {
    EXPECT_NE(OpenRecord3d(path).message().find("a.r3d: no such file"), std::string::npos);
    folder.WriteText("a.r3d", "no archive");
    ExpectRefused(OpenRecord3d(path), "is not a ZIP archive, or it is damaged (Not a zip archive)");
    files["other"] = {};
    ExpectRefused(Reopen(), "has no file 'metadata'");
    files["metadata"] = R3dBytesOf("{]");
    ExpectRefused(Reopen(), "metadata is not valid JSON");
    files["metadata"] = Bytes((64 << 20) + 1, ' ');
    ExpectRefused(Reopen(), "metadata has 67108865 bytes; at most 67108864");
}

TEST_F(Record3d, DamageOfTheFileIsSafe) {
    for (int i = 0; i < 2; ++i) Frame(i, i);
    ASSERT_TRUE(Open(kRecord3dDepthSize).ok());
    const std::string whole = ReadText(path);
    std::mt19937 random(1);
    int refused = 0;
    for (int round = 0; round < 500; ++round) {
        std::string damaged = whole;
        for (int i = 0; i < 3; ++i)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        if (round % 5 == 0) damaged.resize(random() % damaged.size());
        folder.WriteText("a.r3d", damaged);
        const auto recording = OpenRecord3d(path);
        if (!recording.ok()) ++refused;
        for (std::size_t i = 0; recording.ok() && i < recording.value()->info().pairs.size(); ++i)
            if (!recording.value()->Load(i, depth, colour).ok()) ++refused;
    }
    EXPECT_GT(refused, 400);
}

}  // namespace
}  // namespace tessera
