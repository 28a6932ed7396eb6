#include "recordings/lzvn.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes kEnd = {6, 0, 0, 0, 0, 0, 0, 0};

Bytes Ended(Bytes code) {
    code.insert(code.end(), kEnd.begin(), kEnd.end());
    return code;
}

// What the payload decodes to, after some bytes of an earlier block; "damaged" if it is.
std::string Decoded(const Bytes& payload, std::size_t room = 1000) {
    constexpr std::uint8_t kEarlier[] = {'x', 'y'};
    Bytes bytes(2 + room);
    LzOutput output(bytes);
    EXPECT_TRUE(output.Literals(kEarlier));
    if (!DecodeLzvn(payload, output)) return "damaged";
    return {bytes.begin() + 2, bytes.begin() + static_cast<std::ptrdiff_t>(output.written())};
}

TEST(Lzvn, EachOpcode) {
    EXPECT_EQ(Decoded(kEnd), "");
    EXPECT_EQ(Decoded(Ended({0x0e, 0x16})), "");
    EXPECT_EQ(Decoded(Ended({0xe1, 'a', 0xe2, 'b', 'c'})), "abc");
    Bytes literals = {0xe0, 4};
    for (int i = 0; i < 20; ++i) literals.push_back('q');
    EXPECT_EQ(Decoded(Ended(literals)), std::string(20, 'q'));
    // One literal and a small distance, with the match before it, and matches alone.
    EXPECT_EQ(Decoded(Ended({0x48, 1, 'a'})), "aaaaa");
    EXPECT_EQ(Decoded(Ended({0x48, 2, 'a', 0x46, 'b'})), "ayayababa");
    EXPECT_EQ(Decoded(Ended({0x40, 1, 'a', 0xf2, 0xf0, 0})), std::string(4 + 2 + 16, 'a'));
    // Medium and large distances.
    EXPECT_EQ(Decoded(Ended({0xa9, 3 | 2 << 2, 0, 'a'})), "ayayayayaya");
    EXPECT_EQ(Decoded(Ended({0x47, 3, 0, 'a'})), "axya");
    // Into the earlier block.
    EXPECT_EQ(Decoded(Ended({0x00, 2})), "xyx");
}

TEST(Lzvn, DamageIsRefused) {
    const auto refused = [](const Bytes& payload, std::size_t room = 1000) {
        EXPECT_EQ(Decoded(payload, room), "damaged");
    };
    refused({});
    refused({0xe1, 'a'});       // no end
    refused({6, 0, 0, 0});      // half an end
    refused({0xe0, 200, 'a'});  // literals past the end
    refused(Ended(kEnd));       // something after the end
    refused(Ended({0x00, 3}));  // before the start
    refused(Ended({0x00, 0}));  // a distance of nothing
    refused(Ended({0xf3}));     // no distance before
    refused(Ended({0x48, 1, 'a'}), 4);
    refused(Ended({0xe3, 'a', 'b', 'c'}), 2);
    for (int code = 0; code < 256; ++code) {
        const bool undefined = (code & 0xf0) == 0x70 || (code & 0xf0) == 0xd0 ||
                               (code < 0x40 && (code & 7) == 6 && code > 0x16);
        if (undefined) refused(Ended({0xe1, 'a', static_cast<std::uint8_t>(code)}));
    }
}

}  // namespace
}  // namespace tessera
