// Reference values of the recorded sequences. Pairs and stamps come from the TUM tool associate.py.
// Depth and PNG pixels come from a decoder that was written for this purpose from the PNG
// specification. JPEG pixels come from OpenCV.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <set>
#include <string>

#include "io/folder_source.h"

namespace tessera {
namespace {

class RecordedSequences : public testing::Test {
  protected:
    std::unique_ptr<FrameSource> Open(const std::string& name,
                                      const FolderSourceConfig& config = {}) {
        const char* variable = std::getenv("TESSERA_DATA");
        const std::filesystem::path data =
            variable ? variable : TESSERA_SOURCE_DIR "/../shared/data";
        if (!std::filesystem::exists(data / name)) return nullptr;
        auto source = OpenFolderSource((data / name).string(), config);
        EXPECT_TRUE(source.ok()) << source.message();
        return source.ok() ? std::move(source.value()) : nullptr;
    }
};

#define OPEN_OR_SKIP(source, ...)                                                   \
    const auto source = Open(__VA_ARGS__);                                          \
    if (!source)                                                                    \
    GTEST_SKIP()                                                                    \
        << "no test data: set TESSERA_DATA to a folder that holds tum_fr1_rpy and " \
           "tum_fr1_xyz_10 (TUM RGB-D, https://cvg.cit.tum.de/data/datasets/rgbd-dataset)"

Frame ReadFrame(FrameSource& source, std::int64_t index) {
    Frame frame;
    EXPECT_TRUE(source.Seek(index));
    EXPECT_EQ(source.Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, index);
    return frame;
}

double SumOfDepths_m(const Frame& frame) {
    return std::accumulate(frame.depth_m.data(), frame.depth_m.data() + frame.depth_m.size(), 0.0);
}

std::ptrdiff_t Measured(const Frame& frame) {
    return std::count_if(frame.depth_m.data(), frame.depth_m.data() + frame.depth_m.size(),
                         [](float z) { return z > 0; });
}

TEST_F(RecordedSequences, Freiburg1RpyPairsAsTheTumToolDoes) {
    OPEN_OR_SKIP(source, "tum_fr1_rpy");
    EXPECT_EQ(source->info().kind, "TUM RGB-D folder");
    EXPECT_EQ(source->info().frame_count, 694);
    EXPECT_TRUE(source->info().rectified);
    EXPECT_TRUE(source->info().has_truth);
    EXPECT_EQ(source->info().notes[0],
              "28 of 722 depth and 29 of 723 colour images have no partner less than 0.02 s away");
    Frame frame;
    double sum_of_stamps_s = 0, sum_of_gaps_s = 0, first_s = 0;
    for (std::int64_t i = 0; i < 694; ++i) {
        ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
        if (i == 0) first_s = frame.stamp_s;
        sum_of_stamps_s += frame.stamp_s - first_s;
        sum_of_gaps_s += std::abs(frame.stamp_s - frame.colour_stamp_s);
        if (i == 347) {
            EXPECT_EQ(frame.stamp_s, 1305031241.140052);
            EXPECT_EQ(frame.colour_stamp_s, 1305031241.129761);
        }
    }
    EXPECT_EQ(first_s, 1305031229.528784);
    EXPECT_EQ(frame.stamp_s, 1305031253.589805);
    EXPECT_EQ(frame.colour_stamp_s, 1305031253.598121);
    EXPECT_NEAR(sum_of_stamps_s, 8280.582641601562, 1e-3);
    EXPECT_NEAR(sum_of_gaps_s, 7.274928331375122, 1e-4);
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
}

TEST_F(RecordedSequences, Freiburg1RpyHasKnownPixels) {
    OPEN_OR_SKIP(source, "tum_fr1_rpy", {.rectify = false});
    const Frame first = ReadFrame(*source, 0);
    EXPECT_FLOAT_EQ(first.depth_m(320, 240), 6192 / 5000.0f);
    EXPECT_FLOAT_EQ(first.depth_m(500, 400), 7016 / 5000.0f);
    EXPECT_FLOAT_EQ(first.depth_m(0, 0), 5815 / 5000.0f);
    EXPECT_EQ(first.depth_m(100, 100), 0.0f);
    EXPECT_EQ(Measured(first), 217962);
    EXPECT_NEAR(SumOfDepths_m(first), 1482757129 / 5000.0, 0.01);
    EXPECT_EQ(first.colour(320, 240), (Rgb8{26, 17, 20}));
    EXPECT_EQ(first.colour(100, 100), (Rgb8{18, 9, 26}));
    EXPECT_EQ(first.colour(500, 400), (Rgb8{244, 234, 233}));
    // Between the rows of 1305031229.5232 and .5332, interpolated by time.
    ASSERT_TRUE(first.T_world_camera.has_value());
    EXPECT_NEAR(first.T_world_camera->translation().x(), 1.3001 - 0.5584 * 0.0012, 1e-6);
    const Frame last = ReadFrame(*source, 693);
    EXPECT_FLOAT_EQ(last.depth_m(320, 240), 9022 / 5000.0f);
    EXPECT_EQ(Measured(last), 236165);
    EXPECT_NEAR(SumOfDepths_m(last), 2124426212 / 5000.0, 0.01);
}

// The lens correction creates no new depth values. It shrinks this camera's image, so a rim has no
// depth.
TEST_F(RecordedSequences, Freiburg1RpyRectifiedKeepsItsDepths) {
    OPEN_OR_SKIP(source, "tum_fr1_rpy");
    const Frame rectified = ReadFrame(*source, 0);
    const Frame raw = ReadFrame(*Open("tum_fr1_rpy", {.rectify = false}), 0);
    const std::set<float> raw_depths(raw.depth_m.data(), raw.depth_m.data() + raw.depth_m.size());
    for (std::size_t i = 0; i < rectified.depth_m.size(); ++i)
        ASSERT_TRUE(raw_depths.contains(rectified.depth_m.data()[i])) << i;
    EXPECT_NEAR(static_cast<double>(Measured(rectified)), 217962, 0.06 * 217962);
    EXPECT_EQ(rectified.colour.width(), 640);
}

TEST_F(RecordedSequences, Freiburg1XyzHasKnownPixels) {
    OPEN_OR_SKIP(source, "tum_fr1_xyz_10", {.rectify = false});
    EXPECT_EQ(source->info().frame_count, 10);
    const Frame first = ReadFrame(*source, 0);
    EXPECT_EQ(first.stamp_s, 1305031102.1658);
    EXPECT_FLOAT_EQ(first.depth_m(320, 240), 5287 / 5000.0f);
    EXPECT_FLOAT_EQ(first.depth_m(100, 100), 13521 / 5000.0f);
    EXPECT_EQ(Measured(first), 229875);
    EXPECT_NEAR(SumOfDepths_m(first), 1640368667 / 5000.0, 0.01);
    EXPECT_EQ(first.colour(320, 240), (Rgb8{25, 16, 16}));
    EXPECT_EQ(first.colour(0, 0), (Rgb8{137, 124, 126}));
    EXPECT_EQ(first.colour(639, 479), (Rgb8{232, 218, 238}));
    EXPECT_EQ(ReadFrame(*source, 9).stamp_s, 1305031102.4658);
}

}  // namespace
}  // namespace tessera
