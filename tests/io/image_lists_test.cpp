#include "io/image_lists.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

Result<ImagePairs> ReadLists(const TemporaryFolder& folder, const std::string& depth,
                             const std::string& rgb) {
    folder.WriteText("depth.txt", depth);
    folder.WriteText("rgb.txt", rgb);
    return ReadImageLists(folder.Path("depth.txt"), folder.Path("rgb.txt"), 0.02);
}

TEST(ReadImageLists, ReadsCommentsBlankLinesAndCarriageReturns) {
    TemporaryFolder folder;
    const auto images =
        ReadLists(folder, "# depth maps\r\n\r\n1.000 depth/a.png\r\n  2.000\tdepth/b.png\r\n",
                  "\xef\xbb\xbf# colour\n1.010 rgb/a.jpg # late\n\n2.015 rgb/b.jpg");
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[0].depth, "depth/a.png");
    EXPECT_EQ(images.value().pairs[0].colour, "rgb/a.jpg");
    EXPECT_EQ(images.value().pairs[1].depth_stamp_s, 2.0);
    EXPECT_EQ(images.value().pairs[1].colour_stamp_s, 2.015);
    EXPECT_TRUE(images.value().notes.empty());
}

TEST(ReadImageLists, NamesMayContainBlanks) {
    TemporaryFolder folder;
    const auto images =
        ReadLists(folder, "1.0 depth/my  room 1.png \r\n", "1.0\trgb/a b.jpg # not this\n");
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs[0].depth, "depth/my  room 1.png");
    EXPECT_EQ(images.value().pairs[0].colour, "rgb/a b.jpg");
}

TEST(ReadImageLists, StampsThatAreNoTimeAreSkipped) {
    TemporaryFolder folder;
    const auto images = ReadLists(folder, "1.0 d1\n1e300 d2\n-1e13 d3\n", "1.0 c1\n");
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs.size(), 1u);
    EXPECT_EQ(images.value().notes.size(), 1u);
}

TEST(ReadImageLists, WholeNumbersMayBeMilliMicroOrNanoseconds) {
    TemporaryFolder folder;
    const auto images = ReadLists(
        folder, "1700000000123456789 d1\n1700000000223456 d2\n1700000000323 d3\n1700000001 d4\n",
        "1700000000123 c1\n1700000000.223 c2\n1700000000323000000 c3\n1700000001 c4\n");
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_TRUE(images.value().notes.empty());
    const std::vector<ImagePair>& pairs = images.value().pairs;
    ASSERT_EQ(pairs.size(), 4u);
    EXPECT_EQ(pairs[0].depth_stamp_s, 1700000000.123456789);
    EXPECT_EQ(pairs[0].colour_stamp_s, 1700000000.123);
    EXPECT_EQ(pairs[1].depth_stamp_s, 1700000000.223456);
    EXPECT_EQ(pairs[2].depth_stamp_s, 1700000000.323);
    EXPECT_EQ(pairs[2].colour_stamp_s, 1700000000.323);
    EXPECT_EQ(pairs[3].depth_stamp_s, 1700000001);
    EXPECT_EQ(StampOfDigits_s("1403636579763555584"), 1403636579.763555584);
    EXPECT_EQ(StampOfDigits_s("1700000000123"), 1700000000.123);
}

TEST(StampOfDigits, OtherTextsAreNone) {
    for (const char* text : {"", "1700000000", "17000000001234", "170000000012.", "-170000000012",
                             "170000000012x", "1.700000000e+09", "17000000001234567890"})
        EXPECT_FALSE(StampOfDigits_s(text)) << text;
}

TEST(ReadImageLists, SkipsAndNotesWhatIsNoLine) {
    TemporaryFolder folder;
    const auto images =
        ReadLists(folder, "1.0 d1\nnan d2\ngarbage\n3.0\ninf d4\n1e999 d5\n", "1.0 c1\n");
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs.size(), 1u);
    ASSERT_EQ(images.value().notes.size(), 1u);
    EXPECT_EQ(images.value().notes[0],
              folder.Path("depth.txt") +
                  ": 5 lines are not of the form 'stamp filename' (first: line 2); skipped");
}

TEST(ReadImageLists, SortsAndDropsRepeatedStamps) {
    TemporaryFolder folder;
    const auto images =
        ReadLists(folder, "2.0 d2\n1.0 d1\n2.0 again\n", "1.0 c1\n2.0 c2\n3.0 c3\n");
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[0].depth, "d1");
    EXPECT_EQ(images.value().pairs[1].depth, "d2");
    const std::string list = folder.Path("depth.txt");
    EXPECT_EQ(images.value().notes,
              (std::vector<std::string>{
                  list + ": stamps are out of order; sorted",
                  list + ": 1 stamp is repeated; the first image of each is used",
                  "0 of 2 depth and 1 of 3 colour images have no partner less than 0.02 s away"}));
}

TEST(ReadImageLists, SaysTheSmallestGapWhenNothingPairs) {
    TemporaryFolder folder;
    const auto images = ReadLists(folder, "1.0 d1\n2.0 d2\n", "1.5 c1\n2.25 c2\n");
    EXPECT_NE(images.message().find("(the smallest gap is 0.25 s)"), std::string::npos)
        << images.message();
    EXPECT_NE(images.message().find(folder.Path("depth.txt")), std::string::npos);
}

TEST(ReadImageLists, RefusesListsWithoutALine) {
    TemporaryFolder folder;
    EXPECT_EQ(ReadLists(folder, "# nothing\n", "1.0 c1\n").message(),
              folder.Path("depth.txt") + ": no line of the form 'stamp filename'");
    EXPECT_EQ(ReadLists(folder, "1.0 d1\n", std::string("\x00\xff\x01\n\n\x02", 6)).message(),
              folder.Path("rgb.txt") + ": no line of the form 'stamp filename'");
}

TEST(ReadAssociations, TakesDepthFirstOrSecond) {
    TemporaryFolder folder;
    folder.WriteText("associations.txt", "1 depth/1.png 1 rgb/1.png\n2 rgb/2.png 3 depth/2.png\n");
    const auto images = ReadAssociations(folder.Path("associations.txt"));
    ASSERT_TRUE(images.ok()) << images.message();
    ASSERT_EQ(images.value().pairs.size(), 2u);
    EXPECT_EQ(images.value().pairs[0].depth, "depth/1.png");
    EXPECT_EQ(images.value().pairs[1].depth, "depth/2.png");
    EXPECT_EQ(images.value().pairs[1].colour, "rgb/2.png");
    EXPECT_EQ(images.value().pairs[1].depth_stamp_s, 3.0);
    EXPECT_EQ(images.value().pairs[1].colour_stamp_s, 2.0);
}

TEST(ReadAssociations, SkipsLinesThatNameNoOrTwoDepthImages) {
    TemporaryFolder folder;
    folder.WriteText("associations.txt",
                     "1 a.png 1 b.png\n2 depth/2.png 2 depth/2.png\n3 depth/3.png 3 c.png\n4 x\n");
    const auto images = ReadAssociations(folder.Path("associations.txt"));
    ASSERT_TRUE(images.ok()) << images.message();
    EXPECT_EQ(images.value().pairs.size(), 1u);
    EXPECT_EQ(images.value().notes.size(), 1u);
}

}  // namespace
}  // namespace tessera
