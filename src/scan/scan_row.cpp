#include "scan/scan_row.h"

#include <cstring>

#include "scan/checksum.h"

namespace tessera {
namespace {

constexpr int kCoordBits = 21;

}  // namespace

const char* ToString(ScanTable table) {
    constexpr const char* kNames[] = {"meta",      "blocks", "path", "frames",
                                      "keyframes", "poses",  "state"};
    return kNames[IndexOf(table)];
}

std::uint64_t ChecksumOf(const ScanRow& row) {
    const std::int64_t place[] = {static_cast<std::int64_t>(row.table), row.key, row.epoch,
                                  row.checkpoint};
    std::uint8_t bytes[sizeof(place)];
    std::memcpy(bytes, place, sizeof(place));
    return Crc64(row.data, Crc64(bytes));
}

std::int64_t BlockKey(const BlockCoord& coord) {
    const std::uint64_t parts[] = {static_cast<std::uint32_t>(coord.x + kBlockLimit),
                                   static_cast<std::uint32_t>(coord.y + kBlockLimit),
                                   static_cast<std::uint32_t>(coord.z + kBlockLimit)};
    std::uint64_t key = 0;
    for (int bit = 0; bit < kCoordBits; ++bit)
        for (int axis = 0; axis < 3; ++axis) key |= (parts[axis] >> bit & 1) << (3 * bit + axis);
    return static_cast<std::int64_t>(key);
}

BlockCoord CoordOfKey(std::int64_t key) {
    std::int32_t parts[3] = {};
    for (int bit = 0; bit < kCoordBits; ++bit)
        for (int axis = 0; axis < 3; ++axis)
            parts[axis] |=
                static_cast<std::int32_t>(static_cast<std::uint64_t>(key) >> (3 * bit + axis) & 1)
                << bit;
    return {parts[0] - kBlockLimit, parts[1] - kBlockLimit, parts[2] - kBlockLimit};
}

}  // namespace tessera
