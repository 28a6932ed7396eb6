#include "scan/scan_content.h"

#include <fmt/format.h>

#include <algorithm>

#include "optimize/scan_parts.h"
#include "scan/block_codec.h"

namespace tessera {
namespace {

Status DamagedRow(const ScanFile& file, const ScanRow& row) {
    return DamagedScan(file.path(), fmt::format("{} {}", ToString(row.table), row.key));
}

// Block numbers start at 1 and define the allocation order.
Result<std::vector<BlockCoord>> ReadBlockOrder(ScanFile& file) {
    std::vector<std::pair<BlockId, BlockCoord>> blocks;
    Status read = file.Read(ScanTable::kBlocks, [&](const ScanRow& row) {
        const std::optional<std::int32_t> number = BlockCodec::NumberOf(row.data);
        if (!number || row.key < 0)
            return DamagedScan(file.path(), fmt::format("block {}", row.key));
        blocks.emplace_back(*number, CoordOfKey(row.key));
        return Status::Ok();
    });
    if (!read.ok()) return read;
    std::ranges::sort(blocks, {}, &std::pair<BlockId, BlockCoord>::first);
    std::vector<BlockCoord> order;
    for (const auto& [id, coord] : blocks) {
        if (static_cast<std::size_t>(id) != order.size() + 1)
            return DamagedScan(file.path(), fmt::format("{} blocks", blocks.size()));
        order.push_back(coord);
    }
    return order;
}

Status ReadMap(ScanFile& file, bool labels, ScanContent& content) {
    const ScanMeta& meta = content.meta;
    const BlockMap::Config config{.voxel_size_m = meta.voxel_size_m,
                                  .truncation_m = meta.truncation_m,
                                  .band_per_m = meta.band_per_m};
    Result<std::vector<BlockCoord>> order = ReadBlockOrder(file);
    if (!order.ok()) return order.status();
    content.map = std::make_unique<BlockMap>(config);
    BlockMap& map = *content.map;
    if (content.progress.labels || labels) map.EnableLabels();
    for (const BlockCoord& coord : order.value())
        if (map.Allocate(coord) == kUnknownBlock)
            return Status::Error(fmt::format("{}: {} blocks do not fit in this machine's memory",
                                             file.path(), order.value().size()));
    BlockCodec codec;
    BlockCopies block;
    return file.Read(ScanTable::kBlocks, [&](const ScanRow& row) {
        const BlockId id = map.Find(CoordOfKey(row.key));
        block.Clear();
        if (id == kUnknownBlock || !codec.Decode(row.key, row.data, block))
            return DamagedScan(file.path(), fmt::format("block {}", row.key));
        block.Put(0, map, id);
        map.MarkChanged(id, std::max(1u, content.progress.fused_frames));
        return Status::Ok();
    });
}

Status ReadPath(ScanFile& file, ScanContent& content) {
    return file.Read(ScanTable::kPath, [&](const ScanRow& row) {
        PathRecord& record = content.path.emplace_back();
        if (row.key != static_cast<std::int64_t>(content.path.size()) - 1 ||
            !record.Decode(row.data) ||
            record.keyframe >= static_cast<int>(content.keyframes.size()))
            return DamagedRow(file, row);
        return Status::Ok();
    });
}

Status ReadKeyframes(ScanFile& file, ScanContent& content) {
    Status keyframes = file.Read(ScanTable::kKeyframes, [&](const ScanRow& row) {
        Keyframe& keyframe = content.keyframes.emplace_back();
        keyframe.id = static_cast<int>(content.keyframes.size()) - 1;
        return row.key == keyframe.id && DecodeKeyframe(row.data, content.meta.camera, keyframe)
                   ? Status::Ok()
                   : DamagedRow(file, row);
    });
    if (!keyframes.ok()) return keyframes;
    std::size_t posed = 0;
    Status poses = file.Read(ScanTable::kPoses, [&](const ScanRow& row) {
        KeyframePoses both;
        if (row.key != static_cast<std::int64_t>(posed) || posed >= content.keyframes.size() ||
            !both.Decode(row.data))
            return DamagedRow(file, row);
        content.keyframes[posed].T_map_camera = both.T_map_camera;
        content.keyframes[posed++].T_world_camera = both.T_world_camera;
        return Status::Ok();
    });
    if (!poses.ok()) return poses;
    return posed == content.keyframes.size() ? Status::Ok()
                                             : DamagedScan(file.path(), "poses missing");
}

Status ReadStates(ScanFile& file, ScanContent& content) {
    Bytes source, loops;
    for (const auto& [key, bytes] : {std::pair{ScanStateKey::kTracking, &content.tracking},
                                     {ScanStateKey::kLabels, &content.labels},
                                     {ScanStateKey::kSource, &source},
                                     {ScanStateKey::kLoops, &loops}}) {
        Result<Bytes> read = file.ReadOne(key);
        if (!read.ok()) return read.status();
        *bytes = std::move(read.value());
    }
    content.source_name.assign(source.begin(), source.end());
    if (content.source_name.empty()) content.source_name = content.meta.source_name;
    if (!loops.empty() && !content.loops.Decode(loops)) return DamagedScan(file.path(), "loops");
    const int keyframes = static_cast<int>(content.keyframes.size());
    for (const PoseEdge& edge : content.loops.edges)
        if (edge.from < 0 || edge.to < 0 || edge.from >= keyframes || edge.to >= keyframes ||
            edge.from == edge.to)
            return DamagedScan(file.path(), "loops");
    for (const Keyframe& keyframe : content.keyframes)
        for (const Overlap& overlap : keyframe.overlaps)
            if (overlap.with >= keyframe.id) return DamagedScan(file.path(), "keyframes");
    return Status::Ok();
}

Status ReadFrames(ScanFile& file, ScanContent& content) {
    ImageScratch scratch;
    return file.Read(ScanTable::kFrames, [&](const ScanRow& row) {
        FrameRecord record;
        if (!record.Decode(row.data)) return DamagedRow(file, row);
        if (record.in_store && record.stored.keyframe >= static_cast<int>(content.keyframes.size()))
            return DamagedScan(file.path(), "frames without a keyframe");
        const auto images = record.stored.images.Read();
        if (!images.ok()) return images.status();
        record.stored.images = scratch.Keep(*images.value());
        content.frames.push_back(std::move(record));
        return Status::Ok();
    });
}

std::vector<bool> LeftOutOf(const ScanContent& content) {
    std::vector<int> fused(content.keyframes.size(), 0);
    for (const PathRecord& record : content.path)
        if (record.keyframe >= 0) fused[static_cast<std::size_t>(record.keyframe)] += record.fused;
    return OutsideTheLargest(PartsOf(content.loops.edges, content.keyframes), fused);
}

Result<ScanMeta> ReadMeta(ScanFile& file) {
    const Result<Bytes> bytes = file.ReadOne(ScanTable::kMeta, 0);
    if (!bytes.ok()) return bytes.status();
    ScanMeta meta;
    if (!meta.Decode(bytes.value()) || meta.truncation_m < meta.voxel_size_m)
        return DamagedScan(file.path(), "meta");
    return meta;
}

}  // namespace

bool ScanContent::Shows(const Eigen::Isometry3d& T_map) const {
    return keyframes.empty() || std::ranges::any_of(keyframes, [&](const Keyframe& keyframe) {
               return !LeftOut(keyframe.id) && InOnePart(keyframe.T_map_camera, T_map) &&
                      InOnePart(keyframe.T_map_camera, keyframe.T_world_camera);
           });
}

void ScanContent::RemoveHiddenBlocks() {
    if (!map) return;
    for (BlockId id = 1; id < map->size(); ++id)
        if (!map->IsFree(id) && !Shows(PlaceOf(*map, id))) map->Release(id);
}

std::optional<Eigen::Isometry3d> ScanContent::PoseOf(const PathRecord& record) const {
    if (!record.tracked()) return std::nullopt;
    const Eigen::Isometry3d& T = record.T_reference_camera;
    if (record.keyframe < 0) return Shows(T) ? std::optional(T) : std::nullopt;
    if (LeftOut(record.keyframe)) return std::nullopt;
    return Normalised(keyframes[static_cast<std::size_t>(record.keyframe)].T_world_camera * T);
}

std::vector<StampedPose> ScanContent::Path() const {
    std::vector<StampedPose> poses;
    for (const PathRecord& record : path)
        if (const std::optional<Eigen::Isometry3d> T = PoseOf(record))
            poses.push_back({record.stamp_s, *T});
    return poses;
}

std::optional<StampedPose> ScanContent::LastPose() const {
    for (auto record = path.rbegin(); record != path.rend(); ++record) {
        if (!record->tracked()) continue;
        const Eigen::Isometry3d& T = record->T_reference_camera;
        if (record->keyframe < 0) return StampedPose{record->stamp_s, T};
        return StampedPose{
            record->stamp_s,
            Normalised(keyframes[static_cast<std::size_t>(record->keyframe)].T_map_camera * T)};
    }
    return std::nullopt;
}

std::vector<StampedPose> ScanContent::Truth() const {
    std::vector<StampedPose> poses;
    for (const PathRecord& record : path)
        if (record.T_world_camera_truth)
            poses.push_back({record.stamp_s, *record.T_world_camera_truth});
    return poses;
}

Result<ScanMeta> ReadScanMeta(const std::string& path) {
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(path);
    if (!file.ok()) return file.status();
    return ReadMeta(*file.value());
}

Result<ScanContent> ReadScan(const std::string& path, const ScanParts& parts) {
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(path);
    if (!file.ok()) return file.status();
    return ReadScan(*file.value(), parts);
}

Result<ScanContent> ReadScanToShow(const std::string& path, const ScanParts& parts) {
    Result<ScanContent> scan = ReadScan(path, parts);
    if (scan.ok()) scan.value().RemoveHiddenBlocks();
    return scan;
}

Result<ScanContent> ReadScan(ScanFile& file, const ScanParts& parts) {
    ScanContent content;
    content.finished = file.seal().finished;
    Result<ScanMeta> meta = ReadMeta(file);
    if (!meta.ok()) return meta.status();
    content.meta = std::move(meta.value());
    const Result<Bytes> progress = file.ReadOne(ScanStateKey::kProgress);
    if (!progress.ok()) return progress.status();
    if (!progress.value().empty() && !content.progress.Decode(progress.value()))
        return DamagedScan(file.path(), "progress");
    for (const auto& read : {ReadKeyframes, ReadPath, ReadStates})
        if (Status status = read(file, content); !status.ok()) return status;
    content.left_out = LeftOutOf(content);
    if (static_cast<std::int64_t>(content.path.size()) != content.progress.frames)
        return DamagedScan(file.path(), "path");
    // The seal covers every state row, too.
    if (Status status = file.Read(ScanTable::kState, [](const ScanRow&) { return Status::Ok(); });
        !status.ok())
        return status;
    if (parts.map)
        if (Status status = ReadMap(file, parts.labels, content); !status.ok()) return status;
    if (parts.frames)
        if (Status status = ReadFrames(file, content); !status.ok()) return status;
    return content;
}

}  // namespace tessera
