// Time stamps of folders: warnings where they cannot be right, and the correction of a delay.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "io/folder_layout.h"
#include "io/temporary_folder.h"
#include "io/tum_lists.h"

namespace tessera {
namespace {

TEST(FolderLayout, WarnsOfStampsThatCannotBeRight) {
    TemporaryFolder folder;
    folder.WriteText("camera.yaml", kSmallCamera);
    const auto warnings = [&](const std::string& stamps) {
        std::istringstream words(stamps);
        std::string depth, colour;
        int i = 0;
        for (std::string stamp; words >> stamp; ++i) {
            depth += stamp + " depth/" + std::to_string(i) + ".png\n";
            colour += stamp + " rgb/" + std::to_string(i) + ".png\n";
            folder.WriteText("depth/" + std::to_string(i) + ".png", "");
            folder.WriteText("rgb/" + std::to_string(i) + ".png", "");
        }
        folder.WriteText("depth.txt", depth);
        folder.WriteText("rgb.txt", colour);
        const auto layout = ReadFolderLayout(folder.path(), 0.02);
        EXPECT_TRUE(layout.ok()) << layout.message();
        return layout.ok() ? layout.value().warnings : std::vector<std::string>{};
    };
    EXPECT_TRUE(warnings("1.5 1.53 1.56 1.6").empty());
    EXPECT_EQ(warnings("1.5 1.5 1.5 1.5 1.5 1.5"),
              std::vector<std::string>{"only 1 of 6 depth images is used; are the time stamps "
                                       "right, and in seconds?"});
    EXPECT_EQ(
        warnings("1.5 1.53 1e9 1000000000.03"),
        std::vector<std::string>{"time stamps leap by more than 60 s, 1 time (first: by 1e+09 "
                                 "s before depth/2.png)"});
}

TEST(ReadFolderLayout, CorrectsTheTimeStampsThatAreLate) {
    TemporaryFolder folder;
    WriteTumLists(folder);
    folder.WriteText("depth.txt", "1.004 depth/1.png\n1.04 depth/2.png\n");
    folder.WriteText("rgb.txt", "1.02 rgb/1.png\n");
    folder.WriteText("groundtruth.txt",
                     "0.9 0 0 0 0 0 0 1\n0.91 1 0 0 0 0 0 1\n1 10 0 0 0 0 0 1\n"
                     "1.01 11 0 0 0 0 0 1\n1.02 12 0 0 0 0 0 1\n"
                     "1.03 13 0 0 0 0 0 1\n1.04 14 0 0 0 0 0 1\n");
    const auto depth_late = ReadFolderLayout(folder.path(), 0.03, 0.018);
    ASSERT_TRUE(depth_late.ok()) << depth_late.message();
    ASSERT_EQ(depth_late.value().frames.size(), 1u);
    const FolderFrame& frame = depth_late.value().frames[0];
    EXPECT_EQ(frame.depth_path, folder.Path("depth/2.png"));
    EXPECT_NEAR(frame.depth_stamp_s, 1.022, 1e-9);
    EXPECT_EQ(frame.colour_stamp_s, 1.02);
    ASSERT_TRUE(frame.T_world_camera);
    EXPECT_NEAR(frame.T_world_camera->translation().x(), 12.2, 1e-6);

    const auto colour_late = ReadFolderLayout(folder.path(), 0.03, -0.018);
    ASSERT_TRUE(colour_late.ok()) << colour_late.message();
    ASSERT_EQ(colour_late.value().frames.size(), 1u);
    EXPECT_EQ(colour_late.value().frames[0].depth_path, folder.Path("depth/1.png"));
    EXPECT_EQ(colour_late.value().frames[0].depth_stamp_s, 1.004);
    EXPECT_NEAR(colour_late.value().frames[0].colour_stamp_s, 1.002, 1e-9);
}

TEST(ReadFolderLayout, StampsInNamesAreCorrectedBeforeImagesArePaired) {
    TemporaryFolder folder;
    for (const char* name : {"depth/1.004.png", "depth/1.040.png", "rgb/1.020.png"})
        folder.WriteText(name, "");
    const auto layout = ReadFolderLayout(folder.path(), 0.03, 0.018);
    ASSERT_TRUE(layout.ok()) << layout.message();
    ASSERT_EQ(layout.value().frames.size(), 1u);
    EXPECT_EQ(layout.value().frames[0].depth_path, folder.Path("depth/1.040.png"));
    EXPECT_NEAR(layout.value().frames[0].depth_stamp_s, 1.022, 1e-9);
}

TEST(ReadFolderLayout, WhereImagesShareAStampEachGetsHalfOfTheCorrection) {
    TemporaryFolder folder;
    WriteTumLists(folder);
    folder.WriteText("depth.txt", "1.00 depth/1.png\n1.04 depth/2.png\n");
    folder.WriteText("rgb.txt", "1.00 rgb/1.png\n1.04 rgb/2.png\n");
    const auto layout = ReadFolderLayout(folder.path(), 0.03, 0.018);
    ASSERT_TRUE(layout.ok()) << layout.message();
    ASSERT_EQ(layout.value().frames.size(), 2u);
    EXPECT_NEAR(layout.value().frames[1].depth_stamp_s, 1.031, 1e-9);
    EXPECT_NEAR(layout.value().frames[1].colour_stamp_s, 1.049, 1e-9);
}

TEST(ReadFolderLayout, FrameNumbersAreNoTimeStampsToCorrect) {
    TemporaryFolder folder;
    WriteTumLists(folder);
    const auto layout = ReadFolderLayout(folder.path(), 0.02, 0.018);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().correction.depth_s, 0);
    EXPECT_EQ(layout.value().frames[1].depth_stamp_s, 2);
    EXPECT_EQ(layout.value().frames[1].colour_stamp_s, 2);
}

}  // namespace
}  // namespace tessera
