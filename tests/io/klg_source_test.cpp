#include "io/klg_source.h"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cstring>

#include "io/jpeg_encoder.h"
#include "io/temporary_folder.h"

namespace tessera {
namespace {

constexpr Rgb8 kColour{200, 100, 20};

template <typename Number>
void Put(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string Zlib(const std::string& bytes) {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    std::string packed(libdeflate_zlib_compress_bound(compressor, bytes.size()), '\0');
    packed.resize(libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), packed.data(),
                                           packed.size()));
    libdeflate_free_compressor(compressor);
    return packed;
}

std::string Depth(int metres) {
    std::string depth;
    for (int i = 0; i < 32 * 24; ++i)
        Put(depth, static_cast<std::uint16_t>(1000 * metres + i % 32));
    return depth;
}

std::string Colour() {
    std::string colour;
    for (int i = 0; i < 32 * 24; ++i) Put(colour, kColour);
    return colour;
}

std::string Jpeg(int width) {
    std::vector<std::uint8_t> file;
    const ColourImage image(width, 24, kColour);
    EXPECT_TRUE(EncodeJpeg(image, 95, file).ok());
    return {file.begin(), file.end()};
}

std::string FrameOf(std::int64_t stamp_us, const std::string& depth, const std::string& colour) {
    std::string bytes;
    Put(bytes, stamp_us);
    Put(bytes, static_cast<std::int32_t>(depth.size()));
    Put(bytes, static_cast<std::int32_t>(colour.size()));
    return bytes + depth + colour;
}

class Klg : public ::testing::Test {
  protected:
    Klg() { folder.WriteText("camera.yaml", kSmallCamera); }

    void Write(std::int32_t count, const std::string& frames) {
        std::string bytes;
        Put(bytes, count);
        folder.WriteText("a.klg", bytes + frames);
    }
    Result<std::unique_ptr<FrameSource>> Open() {
        return OpenKlgSource(folder.path() + "/a.klg", config);
    }

    TemporaryFolder folder;
    FolderSourceConfig config;
    Frame frame;
};

TEST_F(Klg, CorrectsTheTimeStamps) {
    Write(1, FrameOf(1'500'000, Depth(1), Colour()));
    config.colour_delay_s = 0.02;
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.correction.colour_s, 0.01);
    EXPECT_NEAR(frame.stamp_s, 1.49, 1e-12);
    EXPECT_NEAR(frame.colour_stamp_s, 1.51, 1e-12);
}

TEST_F(Klg, DepthAndColourRawAndPacked) {
    Write(4, FrameOf(1'500'000, Depth(1), Colour()) + FrameOf(1'600'000, Zlib(Depth(2)), Jpeg(32)) +
                 FrameOf(1'700'000, Depth(3), "") + FrameOf(1'800'000, Zlib(Depth(4)), Colour()));
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    FrameSource& klg = *source.value();
    EXPECT_EQ(klg.info().frame_count, 4);
    EXPECT_TRUE(klg.info().notes.empty());
    EXPECT_EQ(klg.info().camera.fx, 30);
    EXPECT_TRUE(klg.info().has_colour);
    for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(klg.Read(frame).status, ReadStatus::kOk) << i;
        EXPECT_EQ(frame.index, i);
        EXPECT_DOUBLE_EQ(frame.stamp_s, 1.5 + 0.1 * i);
        EXPECT_FLOAT_EQ(frame.depth_m(7, 20), static_cast<float>(i) + 1.007f);
        ASSERT_EQ(frame.colour.width(), i == 2 ? 0 : 32);
        if (i == 2) continue;
        EXPECT_NEAR(frame.colour(5, 5).r, kColour.r, i == 1 ? 3 : 0);
        EXPECT_NEAR(frame.colour(5, 5).b, kColour.b, i == 1 ? 3 : 0);
    }
    EXPECT_EQ(klg.Read(frame).status, ReadStatus::kEnd);
    EXPECT_TRUE(klg.Seek(1));
    ASSERT_EQ(klg.Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(0, 0), 2);
    ASSERT_EQ(klg.Stamps_s().size(), 4u);
    EXPECT_EQ(klg.Stamps_s()[1], frame.stamp_s);
}

TEST_F(Klg, RedAndBlueSwappedOnRequest) {
    config.swap_red_blue = true;
    Write(1, FrameOf(1, Depth(1), Colour()));
    const auto source = Open();
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.colour(3, 3).r, kColour.b);
    EXPECT_EQ(frame.colour(3, 3).b, kColour.r);
}

TEST_F(Klg, WhatWasCutOffOrDoesNotGrowIsNoted) {
    const std::string frames =
        FrameOf(10, Depth(1), "") + FrameOf(10, Depth(2), "") + FrameOf(20, Depth(3), "");
    for (const std::size_t missing : {std::size_t{1}, std::size_t{1500}, Depth(3).size() + 5}) {
        Write(3, frames.substr(0, frames.size() - missing));
        const auto source = Open();
        ASSERT_TRUE(source.ok()) << source.message();
        EXPECT_EQ(source.value()->info().frame_count, 1);
        ASSERT_EQ(source.value()->info().warnings.size(), 2u);
        EXPECT_NE(source.value()->info().warnings[0].find("2 of its 3"), std::string::npos);
        EXPECT_NE(source.value()->info().warnings[1].find("1 of 2"), std::string::npos);
    }
}

TEST_F(Klg, ALogThatWasNotClosedIsReadToItsEnd) {
    const std::string frames = FrameOf(10, Depth(1), "") + FrameOf(20, Depth(2), "");
    for (const std::string& cut : {std::string(), FrameOf(30, Depth(3), "").substr(0, 100)}) {
        Write(0, frames + cut);
        const auto source = Open();
        ASSERT_TRUE(source.ok()) << source.message();
        EXPECT_EQ(source.value()->info().frame_count, 2);
        EXPECT_EQ(source.value()->info().warnings,
                  std::vector<std::string>{"the log was not closed; 2 frames were found"});
    }
    Write(0, "");
    EXPECT_EQ(Open().message(), folder.Path("a.klg") + ": contains no complete frame");
}

TEST_F(Klg, OneDamagedStampCostsOneFrame) {
    std::string frames;
    for (const double stamp_us : {10., 20., 1e12, 30., 40., 35., 50., -7., 60.})
        frames += FrameOf(static_cast<std::int64_t>(stamp_us), Depth(1), "");
    Write(9, frames);
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(
        source.value()->info().warnings,
        std::vector<std::string>{"3 of 9 frames are dropped: their time stamps do not increase"});
    std::vector<double> stamps_us;
    while (source.value()->Read(frame).status == ReadStatus::kOk)
        stamps_us.push_back(std::round(frame.stamp_s * 1e6));
    EXPECT_EQ(stamps_us, (std::vector<double>{10, 20, 30, 35, 50, 60}));
}

// The file has two billion bytes of nothing, and none of them is allocated.
TEST_F(Klg, AFrameLargerThanTheCamerasEndsTheLog) {
    std::string huge;
    Put(huge, std::int64_t{2});
    Put(huge, std::int32_t{2'000'000'000});
    Put(huge, std::int32_t{0});
    Write(5, FrameOf(1, Depth(1), "") + huge);
    std::filesystem::resize_file(folder.Path("a.klg"), 2'000'010'000);
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().warnings,
              (std::vector<std::string>{"the log is damaged: frame 1 has 2000000000 bytes of depth "
                                        "and 0 of colour",
                                        "the log is truncated: 1 of its 5 frames are present"}));
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kEnd);
}

TEST_F(Klg, ADamagedFrameIsSkippedAlone) {
    std::string packed = Zlib(Depth(2));
    packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 0x55);
    Write(4, FrameOf(1, Depth(1), "") + FrameOf(2, packed, "") + FrameOf(3, Depth(1), "no JPEG") +
                 FrameOf(4, Depth(1), Jpeg(40)));
    const auto source = Open();
    ASSERT_TRUE(source.ok());
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    for (const char* what :
         {"frame 1: depth is damaged", "frame 2: colour", "frame 3: colour has 40 x 24"}) {
        const ReadResult result = source.value()->Read(frame);
        EXPECT_EQ(result.status, ReadStatus::kSkip);
        EXPECT_NE(result.message.find(what), std::string::npos) << result.message;
    }
}

TEST_F(Klg, WhatIsNoLogIsRefusedByName) {
    const auto refused = [&](const std::string& what) {
        const auto source = Open();
        EXPECT_FALSE(source.ok());
        EXPECT_NE(source.message().find("a.klg"), std::string::npos) << source.message();
        EXPECT_NE(source.message().find(what), std::string::npos) << source.message();
    };
    refused("no such file");
    folder.WriteText("a.klg", "ab");
    refused("is not a .klg log");
    Write(-1, "");
    refused("is not a .klg log");
    // A claimed frame count allocates no memory.
    Write(2'000'000'000, FrameOf(1, Depth(1), "").substr(0, 100));
    refused("no complete frame");
    std::string huge;
    Put(huge, std::int64_t{1});
    Put(huge, std::int32_t{-7});
    Put(huge, std::int32_t{0});
    Write(1, huge);
    refused("frame 0 has -7 bytes");
    folder.WriteText("camera.yaml", "width: 64\nheight: 48\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\n");
    Write(1, FrameOf(1, Depth(1), ""));
    refused("64 x 48");
}

TEST_F(Klg, DepthIsInMillimetresUnlessTheCameraFileSaysOtherwise) {
    folder.WriteText("camera.yaml", "width: 32\nheight: 24\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\n");
    Write(1, FrameOf(1, Depth(1), ""));
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(0, 0), 1);
}

TEST_F(Klg, WithoutACameraFileTheUsualOneIsAssumedAndNoted) {
    std::filesystem::remove(folder.Path("camera.yaml"));
    Write(1, FrameOf(1, std::string(std::size_t{640} * 480 * 2, '\1'), ""));
    const auto source = Open();
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().camera.fx, 528);
    EXPECT_FALSE(source.value()->info().camera_known);
    ASSERT_EQ(source.value()->info().notes.size(), 1u);
    EXPECT_FALSE(source.value()->info().has_colour);
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(639, 479), 0.257f);
}

}  // namespace
}  // namespace tessera
