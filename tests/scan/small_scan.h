// A small scan file with known content (blocks of random voxels, a path and states), written in
// several checkpoints.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "scan/scan_content.h"
#include "scan/scan_writer.h"
#include "support/temp_folder.h"

namespace tessera::testing_support {

inline ScanMeta SmallMeta() {
    ScanMeta meta;
    meta.program = "test";
    meta.source_name = "box room";
    meta.camera = {160, 120, 131.0, 131.0, 79.5, 59.5};
    meta.voxel_size_m = 0.02;
    meta.truncation_m = 0.08;
    meta.configuration = "mapping: {}\n";
    return meta;
}

inline void FillBlock(BlockMap& map, BlockId id, std::uint32_t seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < kBlockVoxels; ++i) {
        map.field(id)[i] = random() & 0x0fff0fffu;
        map.weight(id)[i] = static_cast<std::uint16_t>(random() & 0xff);
        map.colour(id)[i] = random() & 0x00ff00ffu;
    }
    map.MarkChanged(id, 1);
}

inline BlockCoord CoordOfBlock(int i) { return {i % 5 - 2, i / 5 % 4 - 1, i / 20 - 3}; }

inline PathRecord RecordOfFrame(int i) {
    PathRecord record;
    record.index = i;
    record.stamp_s = i / 30.0;
    record.status = i % 7 == 3 ? TrackStatus::kLost : TrackStatus::kGood;
    record.fused = record.tracked();
    if (record.tracked())
        record.T_reference_camera.translation() = Eigen::Vector3d(0.01 * i, 0, 0.5);
    return record;
}

// Writes `checkpoints` checkpoints with `blocks` new blocks and 10 frames each. Each later
// checkpoint also rewrites the first block.
inline std::unique_ptr<BlockMap> WriteSmallScan(const std::string& path, int blocks = 12,
                                                int checkpoints = 3) {
    auto owned =
        std::make_unique<BlockMap>(BlockMap::Config{.voxel_size_m = 0.02, .truncation_m = 0.08});
    BlockMap& map = *owned;
    Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(path, SmallMeta().Encode());
    EXPECT_TRUE(file.ok()) << file.message();
    ScanWriter writer(std::move(file.value()), 5000);
    for (int c = 0; c < checkpoints; ++c) {
        ScanCheckpoint checkpoint;
        std::vector<BlockId> changed;
        for (int i = 0; i < blocks; ++i)
            changed.push_back(map.Allocate(CoordOfBlock(c * blocks + i)));
        if (c > 0) changed.push_back(1);
        for (const BlockId id : changed)
            FillBlock(map, id, static_cast<std::uint32_t>(1000 * c + id));
        checkpoint.blocks.Copy(map, changed);
        for (int i = 0; i < 10; ++i)
            checkpoint.path.emplace_back(10 * c + i, RecordOfFrame(10 * c + i));
        checkpoint.progress = {10 * (c + 1),
                               static_cast<std::uint32_t>(10 * (c + 1)),
                               0,
                               10 * c + 9,
                               (10 * c + 9) / 30.0,
                               false};
        checkpoint.tracking = Bytes(500, static_cast<std::uint8_t>(c));
        checkpoint.finished = c == checkpoints - 1;
        EXPECT_TRUE(writer.Write(checkpoint).ok());
    }
    writer.Close();
    return owned;
}

inline bool SameBlock(const BlockMap& a, BlockId id_a, const BlockMap& b, BlockId id_b) {
    return std::memcmp(a.field(id_a), b.field(id_b), kBlockVoxels * sizeof(FieldWord)) == 0 &&
           std::memcmp(a.weight(id_a), b.weight(id_b), kBlockVoxels * sizeof(std::uint16_t)) == 0 &&
           std::memcmp(a.colour(id_a), b.colour(id_b), kBlockVoxels * sizeof(ColourWord)) == 0;
}

// Compares the block ids too.
inline bool SameMap(const BlockMap& a, const BlockMap& b) {
    if (a.size() != b.size()) return false;
    for (BlockId id = 1; id < a.size(); ++id)
        if (!(a.coord(id) == b.coord(id)) || !SameBlock(a, id, b, id)) return false;
    return true;
}

inline bool SamePath(const std::vector<PathRecord>& a, const std::vector<PathRecord>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].Encode() != b[i].Encode()) return false;
    return true;
}

inline std::string ReadBytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void WriteBytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace tessera::testing_support
