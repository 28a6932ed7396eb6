#include "viz/recent_paths.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

class RecentPaths : public testing::Test {
  protected:
    void Write(const std::string& text) { std::ofstream(file_) << text; }

    TempFolder folder_;
    const std::string file_ = folder_ / "recent";
};

TEST_F(RecentPaths, TheNewestIsFirstAndNoneTwice) {
    for (const char* path : {"/a", "/b", "/a", "/c/../d"}) AddRecentPath(file_, path);
    EXPECT_EQ(ReadRecentPaths(file_), (std::vector<std::string>{"/d", "/a", "/b"}));
}

TEST_F(RecentPaths, TheListIsBounded) {
    for (int i = 0; i < 50; ++i) AddRecentPath(file_, "/run" + std::to_string(i));
    const auto paths = ReadRecentPaths(file_);
    ASSERT_EQ(paths.size(), kMostRecent);
    EXPECT_EQ(paths.front(), "/run49");
    EXPECT_EQ(paths.back(), "/run30");
}

TEST_F(RecentPaths, RelativePathsBecomeAbsolute) {
    AddRecentPath(file_, "here");
    EXPECT_EQ(ReadRecentPaths(file_),
              std::vector{(std::filesystem::current_path() / "here").string()});
}

TEST_F(RecentPaths, TheFolderIsMade) {
    const std::string deep = folder_ / "state/tessera/recent";
    AddRecentPath(deep, "/a");
    EXPECT_EQ(ReadRecentPaths(deep), std::vector<std::string>{"/a"});
}

TEST_F(RecentPaths, HostileContentIsLeftOut) {
    Write("/good\nrelative\n\n/esc\x1b[31mape\n/bad\xff\n" + std::string(5000, '/') +
          "\n/good\n/last");
    EXPECT_EQ(ReadRecentPaths(file_), (std::vector<std::string>{"/good", "/last"}));
    AddRecentPath(file_, "/new\nline");
    EXPECT_EQ(ReadRecentPaths(file_).size(), 2u);
}

TEST_F(RecentPaths, WhatIsNoListIsEmpty) {
    EXPECT_TRUE(ReadRecentPaths(file_).empty());
    EXPECT_TRUE(ReadRecentPaths("").empty());
    EXPECT_TRUE(ReadRecentPaths(folder_.path()).empty());
    std::string long_list;
    while (long_list.size() < 2'000'000) long_list += "/a/path/of/a/run\n";
    Write(long_list);
    EXPECT_TRUE(ReadRecentPaths(file_).empty());
    AddRecentPath("", "/a");
    AddRecentPath("/proc/no/recent", "/a");
}

TEST_F(RecentPaths, TheFileIsWhereTheEnvironmentSays) {
    setenv("XDG_STATE_HOME", "/x", 1);
    setenv("HOME", "/h", 1);
    EXPECT_EQ(RecentFile(), "/x/tessera/recent");
    setenv("XDG_STATE_HOME", "not/absolute", 1);
    EXPECT_EQ(RecentFile(), "/h/.local/state/tessera/recent");
    unsetenv("XDG_STATE_HOME");
    setenv("HOME", "", 1);
    EXPECT_EQ(RecentFile(), "");
}

}  // namespace
}  // namespace tessera
