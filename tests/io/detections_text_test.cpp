#include "io/detections_text.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

Result<DetectionRows> Parse(const std::string& text) {
    const std::string path = ProcessFolder() + "/rows.txt";
    std::ofstream(path) << text;
    return ReadDetectionRows(path);
}

TEST(DetectionsText, CommentsWithAMeaning) {
    const auto read = Parse(
        "# stamp class probability\n# classes cup cell_phone\n# aliases tv=computer\n# frame "
        "1.5\r\n1.5 cup 0.25 1 2 3 4\n# frame 2\n#frame 3\n# frames 4\n");
    ASSERT_TRUE(read.ok()) << read.message();
    const DetectionRows& rows = read.value();
    EXPECT_EQ(rows.frames, (std::vector<double>{1.5, 2}));
    EXPECT_EQ(rows.classes, (std::set<std::string>{"cup", "cell_phone"}));
    EXPECT_EQ(rows.aliases, (ClassAliases{{"tv", "computer"}}));
    ASSERT_EQ(rows.rows.size(), 1u);
    EXPECT_EQ(rows.rows[0].name, "cup");
    EXPECT_FLOAT_EQ(rows.rows[0].probability, 0.25f);
    EXPECT_EQ(rows.rows[0].box, (DetectionBox{1, 2, 3, 4}));
}

TEST(DetectionsText, ClassesOfSeveralDetectorsCountTogether) {
    EXPECT_EQ(Parse("# classes cup tree\n# classes book cup\n").value().classes,
              (std::set<std::string>{"book", "cup", "tree"}));
}

TEST(DetectionsText, NoAliasesIsNotTheSameAsNotSaid) {
    EXPECT_EQ(Parse("# aliases\n# classes \n").value().aliases, ClassAliases{});
    EXPECT_EQ(Parse("# classes\n").value().classes, std::set<std::string>{});
    EXPECT_EQ(Parse("").value().aliases, std::nullopt);
    EXPECT_EQ(Parse("").value().classes, std::nullopt);
}

TEST(DetectionsText, BadCommentsAreNamed) {
    EXPECT_NE(Parse("\n# frame x\n").message().find(":2: expected '# frame"), std::string::npos);
    EXPECT_NE(Parse("# aliases tv=\n").message().find(":1: aliases: 'tv='"), std::string::npos);
}

TEST(DetectionsText, Aliases) {
    const ClassAliases aliases = ParseAliases(" a=b  c_d=e ").value();
    EXPECT_EQ(aliases, (ClassAliases{{"a", "b"}, {"c_d", "e"}}));
    EXPECT_EQ(Renamed(aliases, "c_d"), "e");
    EXPECT_EQ(Renamed(aliases, "b"), "b");
    EXPECT_FALSE(ParseAliases("a").ok());
    EXPECT_FALSE(ParseAliases("=b").ok());
}

TEST(BoxOverlap, OfInclusivePixels) {
    EXPECT_FLOAT_EQ(BoxOverlap({0, 0, 9, 9}, {0, 0, 9, 9}), 1);
    EXPECT_FLOAT_EQ(BoxOverlap({0, 0, 9, 9}, {5, 0, 14, 9}), 50.0f / 150);
    EXPECT_FLOAT_EQ(BoxOverlap({0, 0, 9, 9}, {10, 0, 19, 9}), 0);
    EXPECT_FLOAT_EQ(BoxOverlap({0, 0, -5, -5}, {0, 0, -5, -5}), 0);
}

}  // namespace
}  // namespace tessera
