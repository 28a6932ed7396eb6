// Writes bags with Debian's rosbag (write_bag.py), and checks the images that recordings give back.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "recordings/ros_images_of.h"
#include "recordings/ros_recording.h"

namespace tessera::ros_test {

inline constexpr double kRosGap_s = 0.02;

inline void WriteRosFile(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

// False if rosbag is not installed.
inline bool WriteBag(const std::string& path, const std::string& variant,
                     const std::string& compression) {
    const std::string script = std::string(TESSERA_SOURCE_DIR) + "/tests/recordings/write_bag.py";
    const int state = std::system(
        ("/usr/bin/python3 " + script + " " + path + " " + variant + " " + compression).c_str());
    EXPECT_TRUE(state == 0 || WEXITSTATUS(state) == 77);
    return state == 0;
}

#define WRITE_BAG_OR_SKIP(path, variant, compression) \
    if (!WriteBag(path, variant, compression))        \
    GTEST_SKIP()                                      \
        << "needs rosbag: apt-get install python3-rosbag python3-sensor-msgs python3-tf2-msgs"

template <class Pixels>
bool SamePixels(const Pixels& a, const Pixels& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           std::equal(a.data(), a.data() + a.size(), b.data());
}

inline void ExpectAllImages(Recording& recording, int frames = kFrames) {
    ASSERT_EQ(recording.info().pairs.size(), static_cast<std::size_t>(frames));
    Image<std::uint16_t> depth;
    ColourImage colour;
    for (const int i : {4, 0, 2, 1, 3}) {
        if (i >= frames) continue;
        const Status status = recording.Load(static_cast<std::size_t>(i), depth, colour);
        ASSERT_TRUE(status.ok()) << status.message();
        EXPECT_TRUE(SamePixels(depth, DepthOf(i))) << i;
        EXPECT_TRUE(SamePixels(colour, ColourOf(i))) << i;
        EXPECT_NEAR(recording.info().pairs[static_cast<std::size_t>(i)].depth_stamp_s, StampOf(i),
                    1e-9);
    }
}

}  // namespace tessera::ros_test
