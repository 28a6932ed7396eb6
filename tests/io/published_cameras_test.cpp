#include "io/published_cameras.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace tessera {
namespace {

TEST(PublishedCamera, AgreesWithTheFilesInConfig) {
    int files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/config/cameras")) {
        const auto written = ReadCameraFile(entry.path().string());
        ASSERT_TRUE(written.ok()) << written.message();
        const auto published = PublishedCamera(entry.path().stem().string());
        ASSERT_TRUE(published.has_value()) << entry.path();
        EXPECT_EQ(written.value().pinhole, published->pinhole) << entry.path();
        EXPECT_EQ(written.value().distortion, published->distortion) << entry.path();
        EXPECT_EQ(written.value().depth_scale, published->depth_scale) << entry.path();
        EXPECT_EQ(written.value().fps, published->fps) << entry.path();
        ASSERT_EQ(written.value().colour.has_value(), published->colour.has_value());
        if (published->colour) {
            EXPECT_EQ(written.value().colour->pinhole, published->colour->pinhole);
            EXPECT_TRUE(written.value().colour->T_colour_depth.isApprox(
                published->colour->T_colour_depth, 1e-12));
        }
        ++files;
    }
    EXPECT_EQ(files, 5);
}

TEST(PublishedCamera, KnowsNothingElse) { EXPECT_FALSE(PublishedCamera("freiburg4").has_value()); }

}  // namespace
}  // namespace tessera
