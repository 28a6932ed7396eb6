#include "viz/folder_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

class FolderListing : public testing::Test {
  protected:
    void Touch(const std::string& name) { std::ofstream(folder_ / name) << "x"; }
    void Make(const std::string& name) { std::filesystem::create_directory(folder_ / name); }
    std::vector<std::string> Names() const {
        std::vector<std::string> names;
        for (const FolderEntry& entry : ListFolder(folder_.path()).entries)
            names.push_back(entry.name);
        return names;
    }
    TempFolder folder_;
};

TEST_F(FolderListing, FoldersFirstThenWhatCanBeOpened) {
    for (const char* name : {"b.scan", "a.ply", "C.BAG", "notes.txt", ".hidden.ply"}) Touch(name);
    for (const char* name : {"z", "y", ".git"}) Make(name);
    EXPECT_EQ(Names(), (std::vector<std::string>{"y", "z", "C.BAG", "a.ply", "b.scan"}));
    const FolderEntry first = ListFolder(folder_.path()).entries.front();
    EXPECT_TRUE(first.folder);
    EXPECT_EQ(first.path, folder_ / "y");
}

TEST_F(FolderListing, HostileNamesAreShownSafelyAndKeptAsTheyAre) {
    Make("new\nline\x1b[31m");
    const FolderEntry entry = ListFolder(folder_.path()).entries.at(0);
    EXPECT_EQ(entry.name, "new\\x0aline\\x1b[31m");
    EXPECT_EQ(entry.path, folder_ / "new\nline\x1b[31m");
}

TEST_F(FolderListing, BrokenLinksAndLoopsAreNoFolders) {
    std::filesystem::create_symlink("loop", folder_ / "loop");
    std::filesystem::create_symlink("/no/such", folder_ / "broken");
    EXPECT_TRUE(Names().empty());
    EXPECT_FALSE(ListFolder(folder_.path()).note.empty());
}

TEST_F(FolderListing, ALongListIsCut) {
    for (int i = 0; i < 520; ++i) Touch(std::to_string(1000 + i) + ".ply");
    const FolderList list = ListFolder(folder_.path());
    EXPECT_EQ(list.entries.size(), kMostListed);
    EXPECT_EQ(list.note, "there are more: type the path");
}

TEST_F(FolderListing, WhatCannotBeListedIsSaid) {
    const FolderList list = ListFolder("/no/such");
    EXPECT_TRUE(list.entries.empty());
    EXPECT_NE(list.note.find("/no/such"), std::string::npos);
}

// A name with a colon would otherwise be read as a kind of source.
TEST_F(FolderListing, TheCurrentFolderHasRelativePaths) {
    Make("synthetic:desk");
    Make("plain");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());
    const FolderList list = ListFolder(".");
    EXPECT_EQ(FolderAbove("."), std::filesystem::current_path().parent_path().string());
    EXPECT_EQ(FolderAbove("plain"), ".");
    std::filesystem::current_path(before);
    ASSERT_EQ(list.entries.size(), 2u);
    EXPECT_EQ(list.entries[0].path, "plain");
    EXPECT_EQ(list.entries[1].path, "./synthetic:desk");
}

TEST_F(FolderListing, AboveEndsAtTheRoot) {
    EXPECT_EQ(FolderAbove("/a/b"), "/a");
    EXPECT_EQ(FolderAbove("/a/b/"), "/a");
    EXPECT_EQ(FolderAbove("/a"), "/");
    EXPECT_EQ(FolderAbove("/"), "/");
}

}  // namespace
}  // namespace tessera
