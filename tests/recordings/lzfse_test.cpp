#include "recordings/lzfse.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "recordings/lzfse_encoder.h"

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::vector<std::vector<LzfseBlock>> kKinds = {
    {LzfseBlock::kRaw},
    {LzfseBlock::kLzvn},
    {LzfseBlock::kWide},
    {LzfseBlock::kPacked},
    {LzfseBlock::kPacked, LzfseBlock::kLzvn, LzfseBlock::kRaw, LzfseBlock::kWide}};

Bytes BytesOf(std::string_view text) { return {text.begin(), text.end()}; }

Bytes FromHex(const std::string& hex) {
    Bytes bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

Bytes Random(std::size_t size, unsigned values, unsigned seed) {
    std::mt19937 random(seed);
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % values);
    return bytes;
}

Bytes Repeated(const Bytes& part, std::size_t size) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = part[i % part.size()];
    return bytes;
}

// As the depth of a wall would be: 32-bit numbers that change slowly.
Bytes Wall() {
    Bytes bytes;
    for (int i = 0; i < 10000; ++i) {
        const float depth_m = 2 + 0.001f * static_cast<float>(i % 100 + i / 200);
        const auto* raw = reinterpret_cast<const std::uint8_t*>(&depth_m);
        bytes.insert(bytes.end(), raw, raw + sizeof(depth_m));
    }
    return bytes;
}

// Matches at the least and the largest distance of each symbol.
Bytes FarMatches() {
    Bytes bytes = Random(270000, 256, 7);
    for (std::size_t symbol = 4; symbol < 64; ++symbol)
        for (const std::size_t next : {0u, 1u}) {
            const std::size_t distance =
                ((4 + (symbol + next) % 4) << (symbol + next) / 4) - 4 - next;
            for (int i = 0; i < 9; ++i) bytes.push_back(bytes[bytes.size() - distance]);
        }
    return bytes;
}

// Runs of literals and matches of each length that has a symbol of its own, and around the others.
Bytes AllLengths() {
    Bytes bytes = Random(3000, 256, 8);
    const Bytes fresh = Random(60000, 256, 9);
    std::size_t used = 0;
    for (std::size_t length = 1; length < 2500; length += length < 400 ? 1 : 97) {
        const std::size_t literals = length % 330;
        bytes.insert(bytes.end(), fresh.begin() + static_cast<std::ptrdiff_t>(used),
                     fresh.begin() + static_cast<std::ptrdiff_t>(used + literals));
        used = (used + literals) % 50000;
        for (std::size_t i = 0; i < length + 3; ++i) bytes.push_back(bytes[bytes.size() - 2900]);
    }
    return bytes;
}

bool Decodes(const Bytes& stream, const Bytes& expected) {
    Bytes bytes(expected.size());
    return DecodeLzfse(stream, bytes) && bytes == expected;
}

// From other people's tests, not from our encoder: the first and the third are of dissect.util (the
// SHA-256 of the latter's text begins with 73d3dd96), the second is of the Swift library Wax.
TEST(Lzfse, ReadsPublishedStreams) {
    EXPECT_TRUE(
        Decodes(FromHex("6276786e2c01000013000000c803616263f0fff005e163060000000000000062767824"),
                Repeated(BytesOf("abc"), 300)));
    EXPECT_TRUE(
        Decodes(FromHex("6276783200100000040000000003007000000000000c0050830000002490000ce7d75c03"
                        "0000005c03000000c04ff0937c0f00000000000000000000000000000000000000000000"
                        "000000000000000000c0a30f000000000000000000000000000000000000000000000000"
                        "000000000000000000000000000000000000000000000000000000000000003456ff3f62"
                        "767824"),
                Bytes(4096, 'A')));
    const std::string text =
        "Lorem ipsum dolor sit amet consectetur adipiscing elit. Quisque faucibus ex sapien vitae "
        "pellentesque sem placerat. In id cursus mi pretium tellus duis convallis. Tempus leo eu "
        "aenean sed diam urna tempor. Pulvinar vivamus fringilla lacus nec metus bibendum egestas. "
        "Iaculis massa nisl malesuada lacinia integer nunc posuere. Ut hendrerit semper vel class "
        "aptent taciti sociosqu. Ad litora torquent per conubia nostra inceptos himenaeos.\n\n";
    const std::string stream =
        "62767832df360000a401200e000d0030b92c8bef56220070a5000000398470085f00b0000000383e59c0f109"
        "0000005fc027710c0000fc031c1f03c7700cc70000000000000000006c00003600000000005f07000000e700"
        "000000100060418004120000e06338f9061e8067629dacdf013e836fe041f807be80fd14fc0e3fc29f704700"
        "000000000000000000000000000000000000000000000000000000000000000000000000101288d24318d9f4"
        "46277ac6885a4b5dea360854e4c4616262d667f9f1ff53187e598fe2f5ddf7b768f4bcc1f6441b9e55e0d1be"
        "84b4b91544337f11c4d0d615068c79817f5d19f209c83975cf9669b7f3d1024d9cc795e8ac449090696a7660"
        "585fac1a891c40557bb46c1b62a35ab2608d574e82ba9f3956d0f811370c78d69b24240ffd80ec4eccb6dc1e"
        "7f1c6f2f276a71e9c73183844c3dce83088eeed6c77c3e35316f414db430fcd2e22d0c07998d601addd5907f"
        "852df080386fe69eb78675198704b4bf5361caaf482e9333c6de0d46fbf87b4387fc6ac57116030000000000"
        "0000000066b7fffffff3fffa3ff7ff1fd2273e1f85c5f04f0f4945ab8462767824";
    EXPECT_TRUE(Decodes(FromHex(stream), Repeated(BytesOf(text), 14047)));
}

// From a test of Quamotion's Kaponata: a node of an HFS+ file system's tree, mostly zeros.
TEST(Lzfse, ReadsAPublishedTreeNode) {
    Bytes node(4096);
    const std::pair<std::size_t, int> values[] = {
        {0x8, 1},     {0xb, 3},      {0xf, 2},      {0x13, 3},     {0x17, 0x79},
        {0x1b, 2},    {0x1f, 1},     {0x20, 16},    {0x23, 10},    {0x26, 5},
        {0x2a, 4},    {0x2b, 0xfb},  {0x2f, 0x50},  {0x37, 2},     {0xf8, 0xf8},
        {0xff8, 0xf}, {0xff9, 0xf8}, {0xffb, 0xf8}, {0xffd, 0x78}, {0xfff, 0xe}};
    for (const auto& [place, value] : values) node[place] = static_cast<std::uint8_t>(value);
    const std::string stream =
        "62767832001000002800e0000009001028fdd889111500109f000000155c000867e71b80bd0160031b80fd05"
        "0000c03e7b1f3e04800f812700802700000000000000000000000080bff037f80d5e8017e0050078018017e0"
        "05780100000000000000000000000000000080170000000000000000000078015e0000000000000000000000"
        "000000000000000000000000000000000000000000f81ae0050000009c9b45886f907565b9354a0201000000"
        "0000000000008f8cff670b14fda2e2b27d0162767824";
    Bytes bytes(4096);
    ASSERT_TRUE(DecodeLzfse(FromHex(stream), bytes));
    for (std::size_t i = 0; i < 4096; ++i) EXPECT_EQ(bytes[i], node[i]) << std::hex << i;
}

TEST(Lzfse, RoundTrips) {
    std::vector<Bytes> all = {Random(50000, 256, 1), Random(20000, 3, 2),
                              Random(30000, 40, 3),  Repeated(Random(777, 256, 4), 90000),
                              Bytes(100000, 5),      Wall(),
                              FarMatches(),          AllLengths()};
    for (std::size_t size = 0; size < 40; ++size) all.push_back(Random(size, 4, 5));
    for (const Bytes& bytes : all)
        for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
            const Bytes stream =
                EncodeLzfse(bytes, kKinds[kind], kKinds[kind].size() > 1 ? 90 : 5000);
            EXPECT_EQ(LzfseSize(stream), bytes.size());
            EXPECT_TRUE(Decodes(stream, bytes)) << bytes.size() << " " << kind;
        }
}

TEST(Lzfse, TheSizeMustBeRightAndTheStreamWhole) {
    const Bytes bytes = Random(3000, 20, 1);
    for (const auto& kinds : kKinds) {
        Bytes stream = EncodeLzfse(bytes, kinds, 200);
        for (const std::size_t size : {0u, 2999u, 3001u}) {
            Bytes other(size);
            EXPECT_FALSE(DecodeLzfse(stream, other)) << size;
        }
        Bytes out(bytes.size());
        for (std::size_t cut = 0; cut < stream.size(); ++cut) {
            const Bytes part(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(cut));
            EXPECT_FALSE(DecodeLzfse(part, out)) << cut;
            EXPECT_FALSE(LzfseSize(part)) << cut;
        }
        stream.push_back(1);
        EXPECT_TRUE(Decodes(stream, bytes));
    }
    Bytes nothing;
    EXPECT_FALSE(DecodeLzfse({}, nothing));
    EXPECT_FALSE(DecodeLzfse(BytesOf("bvx3\0\0\0\0bvx$"), nothing));
}

// Run with the address sanitizer, this shows that nothing outside the spans is touched.
TEST(Lzfse, DamageIsSafe) {
    std::mt19937 random(11);
    Bytes bytes = Random(2000, 20, 1);
    const Bytes wall = Wall();
    bytes.insert(bytes.end(), wall.begin(), wall.begin() + 4000);
    int different = 0;
    for (const auto& kinds : kKinds) {
        const Bytes stream = EncodeLzfse(bytes, kinds, 400);
        for (int round = 0; round < 2000; ++round) {
            Bytes damaged = stream;
            const std::size_t range = round % 2 == 0 ? damaged.size() : 200;  // the header
            for (unsigned i = 0; i <= random() % 4; ++i)
                damaged[random() % range] = static_cast<std::uint8_t>(random());
            Bytes out(bytes.size());
            different += DecodeLzfse(damaged, out) && out == bytes ? 0 : 1;
            LzfseSize(damaged);
        }
    }
    EXPECT_GT(different, 8000);
}

// The tables of a packed header have to end with it. Here, their last bytes are zero.
TEST(Lzfse, AHeaderHasNoByteMoreOrLess) {
    const Bytes bytes = Random(500, 20, 1);
    const Bytes stream = EncodeLzfse(bytes, {LzfseBlock::kPacked});
    const std::uint32_t size = stream[24] + 256u * stream[25];
    for (const bool longer : {false, true}) {
        Bytes other = stream;
        const auto last = other.begin() + size - 1;
        ASSERT_EQ(*last, 0);
        longer ? other.insert(last, 0) : other.erase(last);
        other[24] = static_cast<std::uint8_t>(size + (longer ? 1u : -1u));
        other[25] = static_cast<std::uint8_t>((size + (longer ? 1u : -1u)) >> 8);
        EXPECT_FALSE(Decodes(other, bytes)) << longer;
    }
}

}  // namespace
}  // namespace tessera
