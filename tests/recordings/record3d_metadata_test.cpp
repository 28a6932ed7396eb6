#include "recordings/record3d_metadata.h"

#include <gtest/gtest.h>

#include <string>

namespace tessera {
namespace {

TEST(Record3dMetadata, ReadsWhatRecord3dWrites) {
    const auto metadata = ParseRecord3dMetadata(R"({
        "h": 960, "w": 720, "dw": 192, "dh": 256, "fps": 60, "cameraType": 1,
        "K": [700.5, 0, 0, 0, 701, 0, 361.25, 479, 1],
        "initPose": [0, 0, 0, 1, 0, 0, 0],
        "poses": [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 5, 6, 7]],
        "other": {"w": 3, "K": [1], "list": [{"fps": 1}, null, "text", true]},
        "frameTimestamps": [0.5, 0.75]})");
    ASSERT_TRUE(metadata.ok()) << metadata.message();
    EXPECT_EQ(metadata.value().colour_camera, (PinholeCamera{720, 960, 700.5, 701, 361.25, 479}));
    EXPECT_EQ(metadata.value().depth_size, (ImageSize{192, 256}));
    EXPECT_EQ(metadata.value().fps, 60);
    EXPECT_EQ(metadata.value().stamps_s, (std::vector<double>{0.5, 0.75}));
}

// The lens moves to steady the image; one camera is the median of each of its numbers.
TEST(Record3dMetadata, TheCameraIsTheMedianOfAllFrames) {
    const std::string start = R"({"w": 72, "h": 96, "K": [70, 0, 0, 0, 71, 0, 36, 48, 1])";
    const auto metadata = ParseRecord3dMetadata(
        start +
        R"(, "perFrameIntrinsicCoeffs": [[69, 71, 30, 41], [68, 73, 32, 40], [60, 72, 31, 50]]})");
    ASSERT_TRUE(metadata.ok()) << metadata.message();
    EXPECT_EQ(metadata.value().colour_camera, (PinholeCamera{72, 96, 68, 72, 31, 41}));
    for (const char* none : {"}", R"(, "perFrameIntrinsicCoeffs": []})",
                             R"(, "perFrameIntrinsicCoeffs": [[1, 2, 3]]})"}) {
        const auto k = ParseRecord3dMetadata(start + none);
        ASSERT_TRUE(k.ok()) << k.message();
        EXPECT_EQ(k.value().colour_camera, (PinholeCamera{72, 96, 70, 71, 36, 48}));
        EXPECT_EQ(k.value().depth_size, ImageSize{});
        EXPECT_EQ(k.value().fps, 0);
        EXPECT_TRUE(k.value().stamps_s.empty());
    }
}

TEST(Record3dMetadata, SaysWhatIsWrong) {
    const auto expect = [](const std::string& text, const std::string& what) {
        const auto metadata = ParseRecord3dMetadata(text);
        ASSERT_FALSE(metadata.ok()) << text;
        EXPECT_NE(metadata.message().find(what), std::string::npos) << metadata.message();
    };
    const std::string k = R"("K": [70, 0, 0, 0, 71, 0, 36, 48, 1])";
    expect("", "is not valid JSON");
    expect("{", "is not valid JSON at byte 2");
    expect(R"({"w": 72, "h": 1e999, )" + k + "}", "is not valid JSON");
    expect("[]", "'w' and 'h'");
    expect("{" + k + "}", "'w' and 'h'");
    expect(R"({"w": 72, "h": 8193, )" + k + "}", "'w' and 'h'");
    expect(R"({"w": -72, "h": 96, )" + k + "}", "'w' and 'h'");
    expect(R"({"w": [72, 72], "h": 96, )" + k + "}", "'w' and 'h'");
    expect(R"({"w": "72", "h": 96, )" + k + "}", "'w' and 'h'");
    expect(R"({"w": 72, "h": 96})", "0 numbers of the camera");
    expect(R"({"w": 72, "h": 96, "K": [70, 71, 36, 48]})", "4 numbers of the camera");
    expect(R"({"w": 72, "h": 96, "K": [0, 0, 0, 0, 71, 0, 36, 48, 1]})", "fx: 0 is not plausible");
}

TEST(Record3dMetadata, DepthOfNestingIsSafe) {
    const std::size_t levels = 3'000'000;
    EXPECT_FALSE(ParseRecord3dMetadata(std::string(levels, '[')).ok());
    const std::string nested = std::string(levels, '[') + std::string(levels, ']');
    EXPECT_FALSE(ParseRecord3dMetadata("{\"K\": " + nested + "}").ok());
}

}  // namespace
}  // namespace tessera
