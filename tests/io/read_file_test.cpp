#include "io/read_file.h"

#include <sys/stat.h>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

TEST(ReadFileBytes, GivesTheBytes) {
    TemporaryFolder folder;
    folder.WriteText("file", std::string("a\0b", 3));
    std::vector<std::uint8_t> bytes(100, 7);
    ASSERT_TRUE(ReadFileBytes(folder.Path("file"), 3, bytes).ok());
    EXPECT_EQ(bytes, (std::vector<std::uint8_t>{'a', 0, 'b'}));
}

TEST(ReadFileBytes, SaysWhatIsWrong) {
    TemporaryFolder folder;
    folder.WriteText("file", "four");
    ASSERT_EQ(mkfifo(folder.Path("pipe").c_str(), 0600), 0);
    std::vector<std::uint8_t> bytes;
    EXPECT_EQ(ReadFileBytes(folder.Path("absent"), 10, bytes).message(),
              folder.Path("absent") + ": cannot be read: no such file");
    EXPECT_EQ(ReadFileBytes(folder.path(), 10, bytes).message(),
              folder.path() + ": is not a regular file");
    EXPECT_EQ(ReadFileBytes(folder.Path("pipe"), 10, bytes).message(),
              folder.Path("pipe") + ": is not a regular file");
    EXPECT_EQ(ReadFileBytes(folder.Path("file"), 3, bytes).message(),
              folder.Path("file") + ": has 4 bytes; at most 3 bytes are read");
}

}  // namespace
}  // namespace tessera
