// A temporary folder for one test, removed when the test ends, and helpers to write small images
// into it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/image.h"
#include "io/image_io.h"

namespace tessera {

// camera.yaml for 32 x 24 pixels.
inline constexpr const char* kSmallCamera =
    "width: 32\nheight: 24\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\ndepth_scale: 1000\n";

class TemporaryFolder {
  public:
    // `name` is the last part of the path, because some layouts are recognised by it.
    explicit TemporaryFolder(const std::string& name = "sequence") {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        root_ = std::filesystem::path(testing::TempDir()) /
                (std::string(test->test_suite_name()) + "." + test->name());
        std::filesystem::remove_all(root_);
        path_ = root_ / name;
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(root_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string path() const { return path_.string(); }
    std::string Path(const std::string& name) const { return (path_ / name).string(); }

    void WriteText(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    // All pixels have the same value.
    void WriteDepth(const std::string& name, int width, int height, std::uint16_t value) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        ASSERT_TRUE(WriteDepthImage(Path(name), Image<std::uint16_t>(width, height, value)).ok());
    }
    void WriteColour(const std::string& name, int width, int height, Rgb8 colour) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        ASSERT_TRUE(WriteColourImage(Path(name), ColourImage(width, height, colour)).ok());
    }

  private:
    std::filesystem::path root_, path_;
};

inline std::string ReadText(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace tessera
