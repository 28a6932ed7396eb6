// Scan files consist of rows in a few tables, all of the same form. Each row has a checksum over
// its content and its position. docs/scan_format.md describes the format.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mapping/voxel.h"

namespace tessera {

inline constexpr std::int32_t kScanApplicationId = 0x54455353;  // "TESS", in the file's header
// Increment for every change that an older program would read wrongly.
inline constexpr int kScanVersion = 2;
inline constexpr std::size_t kScanPageBytes = 16384;
inline constexpr std::size_t kMaxRowBytes = std::size_t{64} << 20;  // no valid row is larger

enum class ScanTable : std::uint8_t {
    kMeta = 1,
    kBlocks,
    kPath,
    kFrames,
    kKeyframes,
    kPoses,
    kState
};
inline constexpr ScanTable kScanTables[] = {
    ScanTable::kMeta,      ScanTable::kBlocks, ScanTable::kPath, ScanTable::kFrames,
    ScanTable::kKeyframes, ScanTable::kPoses,  ScanTable::kState};
inline constexpr std::size_t kScanTableCount = std::size(kScanTables);
const char* ToString(ScanTable table);  // its name in the file
inline std::size_t IndexOf(ScanTable table) { return static_cast<std::size_t>(table) - 1; }

// Keys of ScanTable::kState. kMeta has only key 0.
enum class ScanStateKey : std::int64_t {
    kSeal,
    kProgress,
    kTracking,
    kLoops,
    kLabels,
    kMetaCopy,
    kSource  // name of the last session's source; none if that is the first session's
};
inline constexpr std::int64_t kSealKey = static_cast<std::int64_t>(ScanStateKey::kSeal);

// `data` belongs to the reader and is valid until its next row.
struct ScanRow {
    ScanTable table = ScanTable::kMeta;
    std::int64_t key = 0;
    // How many times the table was emptied before this row was written.
    std::int64_t epoch = 0;
    std::int64_t checkpoint = 0;  // number of the checkpoint that wrote it, from 0
    std::span<const std::uint8_t> data;
};

std::uint64_t ChecksumOf(const ScanRow& row);

// A block's key: the interleaved bits of its coordinates (Morton order). Neighbouring blocks, which
// tend to change together, thus share pages of the file. Coordinates must be within the map's
// limits.
std::int64_t BlockKey(const BlockCoord& coord);
BlockCoord CoordOfKey(std::int64_t key);

}  // namespace tessera
