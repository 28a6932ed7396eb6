// Scan files: the whole file, its records and blocks.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/input_file.h"
#include "fuzz/fuzz_target.h"
#include "scan/block_codec.h"
#include "scan/scan_content.h"
#include "scan/scan_repair.h"
#include "scan/scan_writer.h"

namespace tessera::fuzz {
namespace {

const PinholeCamera kFuzzCamera{160, 120, 131.0, 131.0, 79.5, 59.5};

std::string TemporaryPath(const char* name) {
    return std::filesystem::temp_directory_path() / fmt::format("fuzz{}.{}", getpid(), name);
}

void RemoveScan(const std::string& path) {
    for (const char* ending : {"", "-wal", "-shm", ".new", ".lock"})
        std::filesystem::remove(path + ending);
}

ScanMeta SomeMeta() {
    ScanMeta meta;
    meta.program = "fuzz";
    meta.source_name = "box room";
    meta.camera = kFuzzCamera;
    meta.voxel_size_m = 0.04;
    meta.truncation_m = 0.16;
    meta.loops = true;
    return meta;
}

FrameRecord SomeFrame() {
    FrameRecord record;
    record.in_store = true;
    record.stored.images = StoredImages({{1, 2, 3}, {4, 5}});
    record.stored.detections.emplace(
        std::vector<Detection>{{"cup", 1, 0.9f, {1, 2, 3, 4}, Image<std::uint8_t>(3, 2)}},
        ClassSet().set(2));
    return record;
}

Keyframe SomeKeyframe() {
    Keyframe keyframe;
    keyframe.depth_m.Resize(4, 3);
    keyframe.reduced.reduction = 4;
    keyframe.reduced.depth.Resize(40, 30);
    keyframe.reduced.luma.Resize(40, 30);
    return keyframe;
}

PathRecord SomePose(int i) {
    PathRecord record;
    record.index = i;
    record.stamp_s = i;
    record.status = TrackStatus::kGood;
    record.keyframe = i > 0 ? 0 : -1;
    record.T_world_camera_truth = Eigen::Isometry3d::Identity();
    return record;
}

LoopProgress SomeProgress() {
    LoopProgress progress;
    progress.next_ordinal = 3;
    progress.edges.push_back(
        {0, 1, Eigen::Isometry3d::Identity(), RootInformation(0.1, 0.1), true});
    return progress;
}

BlockCopies SomeBlocks() {
    BlockCopies blocks;
    for (int i = 1; i <= 3; ++i) {
        blocks.Append({i, -i, 0}, i, true);
        for (std::size_t v = blocks.field.size() - kBlockVoxels; v < blocks.field.size(); ++v) {
            blocks.field[v] = static_cast<FieldWord>(v * 77777u);
            blocks.weight[v] = static_cast<std::uint16_t>(v);
        }
    }
    return blocks;
}

Bytes SomeScan() {
    const std::string path = TemporaryPath("seed.scan");
    RemoveScan(path);
    ScanWriter writer(std::move(ScanFile::Create(path, SomeMeta().Encode()).value()), 5000);
    ScanCheckpoint checkpoint;
    checkpoint.blocks = SomeBlocks();
    for (int i = 0; i < 3; ++i) checkpoint.path.emplace_back(i, SomePose(i));
    checkpoint.frames.emplace_back(1, SomeFrame());
    checkpoint.keyframes.push_back(SomeKeyframe());
    checkpoint.poses.emplace_back(0, KeyframePoses{});
    checkpoint.progress.frames = 3;
    checkpoint.progress.labels = true;
    checkpoint.loops = LoopProgress{};
    checkpoint.finished = true;
    TESSERA_CHECK(writer.Write(checkpoint).ok(), "cannot write {}", path);
    writer.Close();
    const std::string bytes = ReadWholeFile(path, 1 << 24).value();
    RemoveScan(path);
    return BytesOf(bytes);
}

// A damaged file is refused, or gives what was written; it can be repaired, or holds nothing.
void ReadScanBytes(std::span<const std::uint8_t> bytes) {
    const std::string path = TemporaryPath("scan"), repaired = TemporaryPath("repaired.scan");
    for (const std::string& old : {path, repaired}) RemoveScan(old);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    const Result<ScanContent> scan = ReadScan(path, {.map = true, .frames = true});
    CheckError(scan.status(), path);
    if (scan.ok()) (void)scan.value().Path();
    const Result<RepairReport> report = RepairScan(path, repaired);
    CheckError(report.status(), path);
    if (report.ok()) {
        const Result<ScanContent> again = ReadScan(repaired, {.map = true, .frames = true});
        TESSERA_CHECK(again.ok(), "what was repaired cannot be read: {}", again.message());
    }
    for (const std::string& old : {path, repaired}) RemoveScan(old);
}

// What a record decodes to is encoded to a record that decodes to the same.
template <class Record, class Encode, class Decode>
void CheckRecord(std::span<const std::uint8_t> bytes, const Encode& encode, const Decode& decode) {
    Record record, again;
    if (!decode(bytes, record)) return;
    const auto written = encode(record);
    TESSERA_CHECK(decode(written, again), "a record that was read cannot be read again");
    TESSERA_CHECK(encode(again) == written, "a record changes when it is read");
}

template <class Record>
void CheckPlain(std::span<const std::uint8_t> bytes) {
    CheckRecord<Record>(
        bytes, [](const Record& r) { return r.Encode(); },
        [](std::span<const std::uint8_t> from, Record& r) { return r.Decode(from); });
}

// The first byte says which record the others are.
void ReadRecord(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    const auto rest = bytes.subspan(1);
    switch (bytes[0] % 8) {
        case 0: return CheckPlain<ScanMeta>(rest);
        case 1: return CheckPlain<PathRecord>(rest);
        case 2: return CheckPlain<ScanProgress>(rest);
        case 3: return CheckPlain<KeyframePoses>(rest);
        case 4: return CheckPlain<LoopProgress>(rest);
        case 5:
            return CheckRecord<FrameRecord>(
                rest, [](const FrameRecord& r) { return r.Encode().value(); },
                [](std::span<const std::uint8_t> from, FrameRecord& r) { return r.Decode(from); });
        case 6:
            return CheckRecord<Keyframe>(rest, EncodeKeyframe,
                                         [](std::span<const std::uint8_t> from, Keyframe& k) {
                                             return DecodeKeyframe(from, kFuzzCamera, k);
                                         });
        default: break;
    }
    BlockCodec codec;
    BlockCopies blocks;
    if (codec.Decode(BlockKey({1, 2, 3}), rest, blocks))
        TESSERA_CHECK(blocks.size() == 1 && blocks.field.size() == kBlockVoxels, "not one block");
}

std::vector<Bytes> RecordSeeds() {
    BlockCodec codec;
    std::vector<Bytes> records = {SomeMeta().Encode(),
                                  SomePose(1).Encode(),
                                  ScanProgress{}.Encode(),
                                  KeyframePoses{}.Encode(),
                                  SomeProgress().Encode(),
                                  SomeFrame().Encode().value(),
                                  EncodeKeyframe(SomeKeyframe()),
                                  codec.Encode(SomeBlocks(), 0)};
    for (std::size_t i = 0; i < records.size(); ++i)
        records[i].insert(records[i].begin(), static_cast<std::uint8_t>(i));
    return records;
}

}  // namespace

std::vector<FuzzTarget> ScanTargets() {
    return {{"scan", [] { return std::vector<Bytes>{SomeScan()}; }, ReadScanBytes, 300},
            {"scan_records", RecordSeeds, ReadRecord}};
}

}  // namespace tessera::fuzz
