#include "recordings/rvl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "recordings/rvl_encoder.h"

namespace tessera {
namespace {

using Pixels = std::vector<std::uint16_t>;

bool Decodes(const std::string& code, Pixels& pixels) {
    return DecodeRvl({reinterpret_cast<const std::uint8_t*>(code.data()), code.size()}, pixels);
}

TEST(Rvl, ByHand) {
    // Two without depth and three with it: 5 (difference 10 / 2), 6 and 3 (-3 is stored as 5).
    // Nibbles 2, 3, 10 = 2 + 8 * 1 in two, 2, 5, and two of padding, in a little-endian word.
    const std::string code{'\x00', '\x25', '\xa1', '\x23'};
    Pixels pixels(5, 77);
    ASSERT_TRUE(Decodes(code, pixels));
    EXPECT_EQ(pixels, (Pixels{0, 0, 5, 6, 3}));
    EXPECT_EQ(RvlOf(pixels), code);
}

TEST(Rvl, RoundTrips) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        Pixels pixels(1 + random() % 300);
        const auto empty = random() % 5;  // of four
        for (std::uint16_t& pixel : pixels)
            pixel = random() % 4 < empty ? std::uint16_t{0}
                                         : static_cast<std::uint16_t>(random() >> (random() % 32));
        pixels[random() % pixels.size()] = 65535;
        Pixels decoded(pixels.size(), 77);
        ASSERT_TRUE(Decodes(RvlOf(pixels), decoded));
        ASSERT_EQ(decoded, pixels);
    }
}

TEST(Rvl, DamageIsRefused) {
    const Pixels pixels{0, 0, 5, 600, 3, 0, 0, 0, 40000, 40001, 9, 60000, 0, 1};
    const std::string code = RvlOf(pixels);
    Pixels decoded(pixels.size());
    for (std::size_t size = 0; size < code.size(); size += 4)
        EXPECT_FALSE(Decodes(code.substr(0, size), decoded)) << size;
    const auto refused = [](const std::string& word, std::size_t count) {
        Pixels room(count);
        EXPECT_FALSE(Decodes(word, room)) << word;
    };
    refused({'\x00', '\x00', '\x00', '\x30'}, 2);                            // three without depth
    refused({'\x00', '\x00', '\x00', '\x03'}, 2);                            // three with it
    refused({'\x00', '\x00', '\x10', '\x01'}, 1);                            // a depth below 0
    refused({'\x88', '\xc8', '\x88', '\x01', '\0', '\0', '\0', '\x10'}, 1);  // above 65535
    refused(std::string(400, '\0'), 5);                                      // runs of nothing
    refused(std::string(400, '\xff'), 5);                                    // a number without end
}

TEST(Rvl, AnyBytesAreReadWithinThem) {
    std::mt19937 random(4);
    for (int round = 0; round < 20000; ++round) {
        std::string code(random() % 40, '\0');
        std::ranges::generate(code, [&] { return static_cast<char>(random() & random()); });
        Pixels pixels(random() % 50);
        Decodes(code, pixels);
    }
}

}  // namespace
}  // namespace tessera
