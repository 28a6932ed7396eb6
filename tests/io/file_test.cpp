#include "io/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/input_file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  testing::UnitTest::GetInstance()->current_test_info()->name();
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    std::string Path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t FilesInFolder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    std::string Text(const std::string& name) const {
        const auto text = ReadWholeFile(Path(name), 1 << 20);
        return text.ok() ? text.value() : "error: " + text.message();
    }
    fs::path folder_;
};

TEST_F(FileTest, WritesAndReplacesWithoutDebris) {
    ASSERT_TRUE(WriteTextFile(Path("a.txt"), "one\n").ok());
    ASSERT_TRUE(WriteTextFile(Path("a.txt"), "two\n").ok());
    EXPECT_EQ(Text("a.txt"), "two\n");
    EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(FileTest, KeepsTheOldFileWhenGivenUp) {
    ASSERT_TRUE(WriteTextFile(Path("a.txt"), "old").ok());
    {
        AtomicFile file(Path("a.txt"));
        file.Write("new");
    }
    EXPECT_EQ(Text("a.txt"), "old");
    EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(FileTest, PiecesOfAnySizeStayInOrder) {
    std::string all;
    AtomicFile file(Path("a.txt"));
    for (const std::size_t size : {3u, 65000u, 600u, 70000u, 1u, 65536u, 65535u, 2u, 200000u, 5u}) {
        const std::string piece(size, static_cast<char>('a' + all.size() % 26));
        file.Write(piece);
        all += piece;
    }
    EXPECT_FALSE(fs::exists(Path("a.txt")));
    ASSERT_TRUE(file.Commit().ok());
    EXPECT_TRUE(Text("a.txt") == all);
}

TEST_F(FileTest, KeepsModeAndSymbolicLink) {
    ASSERT_TRUE(WriteTextFile(Path("target"), "old").ok());
    ASSERT_EQ(chmod(Path("target").c_str(), 0600), 0);
    fs::create_symlink("target", folder_ / "link");
    ASSERT_TRUE(WriteTextFile(Path("link"), "new").ok());
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(Text("target"), "new");
    struct stat info {};
    ASSERT_EQ(stat(Path("target").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777u, 0600u);
}

TEST_F(FileTest, SaysDiskFullAndLeavesTheDeviceAlone) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full (Linux)";
    const Status status = WriteTextFile("/dev/full", "text");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("/dev/full"), std::string::npos);
    EXPECT_NE(status.message().find("no space left"), std::string::npos);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(FileTest, SaysWhatIsWrongWithTheTarget) {
    const Status folder = WriteTextFile(folder_.string(), "text");
    EXPECT_NE(folder.message().find("is a folder"), std::string::npos) << folder.message();
    const Status absent = WriteTextFile(Path("no/such/file"), "text");
    EXPECT_NE(absent.message().find("folder does not exist"), std::string::npos);
    EXPECT_EQ(FilesInFolder(), 0u);
}

TEST_F(FileTest, PreparesNestedFoldersAndLeavesThemEmpty) {
    ASSERT_TRUE(PrepareOutputFolder(Path("a/b/c")).ok());
    ASSERT_TRUE(PrepareOutputFolder(Path("a/b/c")).ok());
    EXPECT_TRUE(fs::is_empty(folder_ / "a/b/c"));
}

TEST_F(FileTest, RefusesAFileAsOutputFolder) {
    ASSERT_TRUE(WriteTextFile(Path("file"), "text").ok());
    EXPECT_NE(PrepareOutputFolder(Path("file")).message().find("is a file"), std::string::npos);
    EXPECT_FALSE(PrepareOutputFolder(Path("file/below")).ok());
    EXPECT_FALSE(PrepareOutputFolder("").ok());
}

TEST_F(FileTest, RefusesAFolderThatCannotBeWrittenTo) {
    if (!fs::exists("/proc/self")) GTEST_SKIP() << "needs /proc (Linux)";
    const Status status = PrepareOutputFolder("/proc/self");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("/proc/self"), std::string::npos);
}

}  // namespace
}  // namespace tessera
