// The bytes of a stream of small frames, as a sender writes them, and the check of a frame read.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/frame_source.h"

namespace tessera::pipe_source_test {

inline constexpr int kWidth = 32, kHeight = 24;

template <typename Number>
void Put(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

inline std::string Greeting(const std::string& more = "") {
    const std::string camera = "width: 32\nheight: 24\nfx: 30\nfy: 30\ncx: 15.5\ncy: 11.5\n" + more;
    std::string bytes = "TESSERA1";
    Put(bytes, static_cast<std::uint32_t>(camera.size()));
    return bytes + camera;
}

inline std::uint16_t DepthAt(int number, int i) {
    return static_cast<std::uint16_t>(1000 + number + i);
}

inline std::string RawDepth(int number) {
    std::string depth;
    for (int i = 0; i < kWidth * kHeight; ++i) Put(depth, DepthAt(number, i));
    return depth;
}

inline std::string RawColour(int number) {
    std::string colour;
    for (int i = 0; i < 3 * kWidth * kHeight; ++i) colour += static_cast<char>(number + i);
    return colour;
}

inline std::string FrameOf(int number, const std::string& depth, const std::string& colour) {
    std::string bytes;
    Put(bytes, std::int64_t{1000000} + 33333 * number);
    Put(bytes, static_cast<std::int32_t>(depth.size()));
    Put(bytes, static_cast<std::int32_t>(colour.size()));
    return bytes + depth + colour;
}
inline std::string FrameOf(int number) {
    return FrameOf(number, RawDepth(number), RawColour(number));
}

inline void ExpectFrame(const Frame& frame, int number) {
    EXPECT_NEAR(frame.stamp_s, 1 + 0.033333 * number, 1e-9);
    EXPECT_EQ(frame.stamp_s, frame.colour_stamp_s);
    ASSERT_EQ(frame.depth_m.width(), kWidth);
    for (int i = 0; i < kWidth * kHeight; ++i)
        ASSERT_FLOAT_EQ(frame.depth_m.data()[i], 0.001f * static_cast<float>(DepthAt(number, i)));
    if (frame.colour.empty()) return;
    const auto* colour = reinterpret_cast<const char*>(frame.colour.data());
    ASSERT_EQ(std::string(colour, 3 * frame.colour.size()), RawColour(number));
}

}  // namespace tessera::pipe_source_test
