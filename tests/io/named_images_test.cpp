#include "io/named_images.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

// Only the names matter here, so the files are empty.
void Touch(const TemporaryFolder& folder, const std::vector<std::string>& names) {
    for (const std::string& name : names) folder.WriteText(name, "");
}

Result<ImagePairs> Pair(const TemporaryFolder& folder) {
    return PairByName(folder.path(), FindImageFolders(folder.path()), 10.0, 0.02);
}

TEST(FindImageFolders, KnowsTheUsualNames) {
    TemporaryFolder folder;
    EXPECT_FALSE(FindImageFolders(folder.path()).complete());
    Touch(folder, {"depth/1.png", "color/1.png"});
    const ImageFolders found = FindImageFolders(folder.path());
    EXPECT_TRUE(found.complete());
    EXPECT_EQ(found.colour, "color");
}

TEST(PairByName, PairsByNumberNotByAlphabet) {
    TemporaryFolder folder;
    Touch(folder, {"depth/d2.png", "depth/d10.png", "depth/d7.png", "depth/readme.txt",
                   "depth/.hidden.png", "rgb/0002.jpg", "rgb/0010.jpg", "rgb/0011.jpg"});
    const auto images = Pair(folder);
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[0].depth, "depth/d2.png");
    EXPECT_EQ(images.value().pairs[0].depth_stamp_s, 0.2);
    EXPECT_EQ(images.value().pairs[1].colour, "rgb/0010.jpg");
    EXPECT_EQ(images.value().pairs[1].depth_stamp_s, 1.0);
    EXPECT_EQ(images.value().notes,
              std::vector<std::string>{"1 of 3 depth and 1 of 3 colour images have no partner"});
}

TEST(PairByName, PairsByStampsInNames) {
    TemporaryFolder folder;
    Touch(folder, {"depth/1305031229.528784.png", "depth/1305031229.564442.png",  //
                   "rgb/1305031229.528748.png", "rgb/1305031229.704425.png"});
    const auto images = Pair(folder);
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 1u);
    EXPECT_EQ(images.value().pairs[0].depth_stamp_s, 1305031229.528784);
    EXPECT_EQ(images.value().pairs[0].colour_stamp_s, 1305031229.528748);
}

TEST(PairByName, ReadsNanoseconds) {
    TemporaryFolder folder;
    Touch(folder, {"depth/1403636579763555584.png", "rgb/1403636579763000000.png"});
    const auto images = Pair(folder);
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs[0].depth_stamp_s, 1403636579.763555584);
    EXPECT_EQ(images.value().pairs[0].colour_stamp_s, 1403636579.763);
}

TEST(PairByName, NumbersWithZerosBeforeThemAreNoStamps) {
    TemporaryFolder folder;
    Touch(folder, {"depth/0000000000000042.png", "rgb/0000000000000042.png"});
    const auto images = Pair(folder);
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs[0].depth_stamp_s, 4.2);
}

TEST(PairByName, PairsByOrderWhereNamesHaveNoNumbers) {
    TemporaryFolder folder;
    Touch(folder, {"depth/b.png", "depth/a.png", "image/y.png", "image/x.png"});
    const auto images = Pair(folder);
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[1].depth, "depth/b.png");
    EXPECT_EQ(images.value().pairs[1].colour, "image/y.png");
    EXPECT_EQ(images.value().pairs[1].depth_stamp_s, 0.1);
}

TEST(PairByName, SaysWhyNothingPairs) {
    TemporaryFolder folder;
    Touch(folder, {"depth/1.png", "rgb/note.txt"});
    EXPECT_EQ(Pair(folder).message(), folder.Path("rgb") + ": contains no images");
    Touch(folder, {"rgb/2.png"});
    EXPECT_NE(Pair(folder).message().find("cannot be paired by name"), std::string::npos);
}

TEST(ReadSevenScenesNames, PairsByFrameNumber) {
    TemporaryFolder folder;
    Touch(folder, {"frame-000000.color.png", "frame-000000.depth.png", "frame-000002.color.png",
                   "frame-000002.depth.png", "frame-000003.color.png", "frame-000000.pose.txt"});
    const auto images = ReadSevenScenesNames(folder.path(), 30.0);
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[1].depth, "frame-000002.depth.png");
    EXPECT_EQ(images.value().pairs[1].colour, "frame-000002.color.png");
    EXPECT_DOUBLE_EQ(images.value().pairs[1].depth_stamp_s, 2.0 / 30.0);
    EXPECT_EQ(images.value().notes.size(), 1u);
}

}  // namespace
}  // namespace tessera
