#include "optimize/stored_images.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "support/temp_folder.h"

namespace tessera {
namespace {

EncodedImages SomeImages(std::uint8_t seed, std::size_t bytes = 300000) {
    return {std::vector<std::uint8_t>(bytes, seed),
            std::vector<std::uint8_t>(bytes / 3, static_cast<std::uint8_t>(seed + 1))};
}

void ExpectRead(const StoredImages& stored, const EncodedImages& images) {
    const auto read = stored.Read();
    ASSERT_TRUE(read.ok()) << read.message();
    EXPECT_EQ(read.value()->depth_png, images.depth_png);
    EXPECT_EQ(read.value()->colour_jpeg, images.colour_jpeg);
}

TEST(StoredImages, AreReadFromTheFileAfterItsScratchIsGone) {
    const TempFolder folder;
    std::vector<StoredImages> stored;
    {
        ImageScratch scratch(folder.path());
        for (std::uint8_t i = 0; i < 5; ++i)
            stored.push_back(scratch.Keep(SomeImages(i, 1000u + i)));
        stored.push_back(scratch.Keep({{1, 2, 3}, {}}));
        EXPECT_EQ(scratch.TakeTrouble(), "");
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));  // the file has no name
    const std::vector<StoredImages> copies = stored;
    stored.erase(stored.begin() + 1, stored.begin() + 4);
    for (std::uint8_t i = 0; i < 5; ++i) {
        EXPECT_EQ(copies[i].memory_bytes(), 0u);
        ExpectRead(copies[i], SomeImages(i, 1000u + i));
    }
    ExpectRead(stored.back(), {{1, 2, 3}, {}});
    ExpectRead(StoredImages(), {});
}

// The range of images that nobody holds any more is free again.
TEST(StoredImages, ThatAreDroppedGiveTheirSpaceBack) {
    const TempFolder folder;
    auto file = TemporaryFile::CreateBeside(folder / "x").value();
    ASSERT_TRUE(file->Write(std::vector<std::uint8_t>(100, 7), 0).ok());
    file->Discard(0, 4096);
    std::vector<std::uint8_t> back(100);
    ASSERT_TRUE(file->Read(back, 0).ok());
    if (back[0] != 0) GTEST_SKIP() << "the file system cannot give space back";
    ImageScratch scratch(folder.path());
    const std::uint64_t before = file->FreeOnDisk();
    std::vector<StoredImages> stored;
    for (int i = 0; i < 20; ++i) stored.push_back(scratch.Keep(SomeImages(1, 5 << 20)));
    const StoredImages kept = stored[7];
    stored.clear();
    ExpectRead(kept, SomeImages(1, 5 << 20));
    // Other processes write here, too.
    EXPECT_LT(before - std::min(before, file->FreeOnDisk()), std::uint64_t{50} << 20);
}

TEST(StoredImages, StayInMemoryWhereTheFileCannotBeMade) {
    ImageScratch scratch("/absent");
    const StoredImages stored = scratch.Keep(SomeImages(4));
    EXPECT_EQ(stored.memory_bytes(), 400000u);
    ExpectRead(stored, SomeImages(4));
    EXPECT_EQ(
        scratch.TakeTrouble(),
        "frames for corrected maps are kept in memory: /absent/tessera-frames: cannot create a "
        "temporary file next to it: the folder does not exist; create it or choose another "
        "location");
    scratch.Keep(SomeImages(5));
    EXPECT_EQ(scratch.TakeTrouble(), "");  // said once
}

TEST(TemporaryFile, SaysWhenItIsShorterThanWhatIsRead) {
    const TempFolder folder;
    auto file = TemporaryFile::CreateBeside(folder / "x").value();
    ASSERT_TRUE(file->Write(std::vector<std::uint8_t>(100, 7), 0).ok());
    std::vector<std::uint8_t> back(101);
    EXPECT_EQ(file->Read(back, 0).message(), "cannot be read: Input/output error");
}

}  // namespace
}  // namespace tessera
