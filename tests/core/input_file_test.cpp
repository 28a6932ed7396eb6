#include "core/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <fstream>
#include <utility>

#include "support/temp_folder.h"

namespace tessera {
namespace {

std::string WriteFile(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

TEST(InputFile, GivesTheBytes) {
    const TempFolder folder;
    const std::string path = WriteFile(folder / "file", std::string("a\0bc", 4));
    std::vector<std::uint8_t> bytes(100, 7);
    ASSERT_TRUE(ReadFileBytes(path, 4, bytes).ok());
    EXPECT_EQ(bytes, (std::vector<std::uint8_t>{'a', 0, 'b', 'c'}));
    EXPECT_EQ(ReadWholeFile(path, 4).value(), std::string("a\0bc", 4));
    EXPECT_EQ(ReadWholeFile(WriteFile(folder / "empty", ""), 0).value(), "");
    InputFile first = std::move(InputFile::Open(path).value());
    const InputFile file = std::move(first);
    EXPECT_EQ(file.size(), 4u);
    std::array<std::uint8_t, 2> two{};
    ASSERT_TRUE(file.ReadAt(2, two).ok());
    EXPECT_EQ(two, (std::array<std::uint8_t, 2>{'b', 'c'}));
    EXPECT_EQ(file.ReadAt(3, two).message(),
              path + ": cannot be read: it became shorter meanwhile");
}

TEST(InputFile, SaysWhatIsWrongAndWaitsForNothing) {
    const TempFolder folder;
    WriteFile(folder / "file", "four");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const auto message = [&](const std::string& path) { return ReadWholeFile(path, 3).message(); };
    EXPECT_EQ(message(folder / "absent"), folder / "absent: no such file");
    EXPECT_EQ(message(folder / "file/x"), folder / "file/x: no such file");
    EXPECT_EQ(message(folder.path()), folder.path() + ": is a folder; give a file");
    EXPECT_EQ(message(folder / "pipe"),
              folder / "pipe: is a pipe or a device; give a regular file");
    EXPECT_EQ(message("/dev/zero"), "/dev/zero: is a pipe or a device; give a regular file");
    EXPECT_EQ(message(folder / "file"), folder / "file: has 4 bytes; at most 3 bytes are read");
}

}  // namespace
}  // namespace tessera
