#include "scan/scan_row.h"

#include <gtest/gtest.h>

#include <set>

#include "scan/checksum.h"

namespace tessera {
namespace {

TEST(Crc64, IsCrc64Xz) {
    const std::string text = "123456789";  // the check value published for this CRC
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    EXPECT_EQ(Crc64(bytes), 0x995dc9bbdf1939faull);
    EXPECT_EQ(Crc64(bytes.subspan(4), Crc64(bytes.first(4))), Crc64(bytes));
    EXPECT_EQ(Crc64({}), 0u);
}

TEST(ScanRow, AnotherPlaceIsAnotherChecksum) {
    const std::vector<std::uint8_t> data{1, 2, 3};
    const ScanRow row{ScanTable::kBlocks, 5, 1, 2, data};
    std::set<std::uint64_t> checksums{ChecksumOf(row)};
    ScanRow other = row;
    other.key = 6;
    checksums.insert(ChecksumOf(other));
    other = row;
    other.table = ScanTable::kPath;
    checksums.insert(ChecksumOf(other));
    other = row;
    other.epoch = 2;
    checksums.insert(ChecksumOf(other));
    other = row;
    other.checkpoint = 3;
    checksums.insert(ChecksumOf(other));
    EXPECT_EQ(checksums.size(), 5u);
}

TEST(ScanRow, ABlocksKeyIsItsCoordinate) {
    std::set<std::int64_t> keys;
    const std::int32_t values[] = {-kBlockLimit, -17, -1, 0, 1, 8, kBlockLimit - 1};
    for (const std::int32_t x : values)
        for (const std::int32_t y : values)
            for (const std::int32_t z : values) {
                const BlockCoord c{x, y, z};
                EXPECT_GE(BlockKey(c), 0);
                EXPECT_TRUE(CoordOfKey(BlockKey(c)) == c);
                keys.insert(BlockKey(c));
            }
    EXPECT_EQ(keys.size(), 7u * 7 * 7);
    // The keys of the eight blocks of an even cube are consecutive.
    EXPECT_EQ(BlockKey({5, 7, 9}) - BlockKey({4, 6, 8}), 7);
}

}  // namespace
}  // namespace tessera
