#include "scan/scan_writer.h"

#include "io/image_io.h"
#include "io/jpeg_encoder.h"

namespace tessera {

void ScanCheckpoint::Clear() {
    clear_all = clear_blocks = finished = false;
    path.clear();
    frames.clear();
    raw_frames.clear();
    keyframes.clear();
    poses.clear();
    source.clear();
    tracking.clear();
    labels.clear();
    stored.reset();
    loops.reset();
}

Status ScanWriter::Write(const ScanCheckpoint& checkpoint) {
    file_->Begin();
    PutRows(checkpoint);
    return file_->Commit(checkpoint.finished);
}

void ScanWriter::PutRows(const ScanCheckpoint& c) {
    if (c.clear_all)
        for (const ScanTable table : kScanTables)
            if (table != ScanTable::kMeta && table != ScanTable::kState) file_->Clear(table);
    if (c.clear_blocks && !c.clear_all) file_->Clear(ScanTable::kBlocks);
    if (c.stored) {
        const auto put = [this](std::int64_t key, std::span<const std::uint8_t> data) {
            file_->Put(ScanTable::kBlocks, key, data);
            return file_->error();
        };
        if (Status status = c.stored->ForEachRow(put); !status.ok()) return file_->Abandon(status);
    }
    // In key order, so that each page is touched once.
    for (const auto& [key, i] : c.blocks.ByKey())
        file_->Put(ScanTable::kBlocks, key, codec_.Encode(c.blocks, i));
    for (const auto& [number, record] : c.path)
        file_->Put(ScanTable::kPath, number, record.Encode());
    // Skips images that cannot be read or encoded. A map that is fused again lacks their frame, and
    // after a resume no camera is found at its keyframe.
    const auto put_frame = [this](std::int64_t number, const Result<Bytes>& record) {
        if (record.ok()) file_->Put(ScanTable::kFrames, number, record.value());
    };
    for (const auto& [number, record] : c.frames) put_frame(number, record.Encode());
    for (const auto& [number, frame] : c.raw_frames) put_frame(number, Compress(*frame));
    for (const Keyframe& keyframe : c.keyframes)
        file_->Put(ScanTable::kKeyframes, keyframe.id, EncodeKeyframe(keyframe));
    for (const auto& [number, poses] : c.poses)
        file_->Put(ScanTable::kPoses, number, poses.Encode());
    file_->Put(ScanStateKey::kProgress, c.progress.Encode());
    if (!c.source.empty())
        file_->Put(ScanStateKey::kSource, Bytes(c.source.begin(), c.source.end()));
    // An empty state is none. What is not given is none after a reset; else it stays.
    const Bytes loops = c.loops ? c.loops->Encode() : Bytes();
    for (const auto& [state_key, bytes] : {std::pair{ScanStateKey::kTracking, &c.tracking},
                                           {ScanStateKey::kLabels, &c.labels},
                                           {ScanStateKey::kLoops, &loops}})
        if (!bytes->empty() || c.clear_all) file_->Put(state_key, *bytes);
}

Result<Bytes> ScanWriter::Compress(const Frame& frame) {
    constexpr int kJpegQuality = 92;
    FrameRecord record;
    record.index = frame.index;
    record.stamp_s = frame.stamp_s;
    record.colour_stamp_s = frame.colour_stamp_s;
    StoreDepth(frame.depth_m, depth_units_per_m_, raw_depth_);
    EncodedImages images;
    png_.EncodeDepth(raw_depth_, images.depth_png);
    if (!frame.colour.empty())
        if (Status status = EncodeJpeg(frame.colour, kJpegQuality, images.colour_jpeg);
            !status.ok())
            return status;
    record.stored.images = StoredImages(std::move(images));
    return record.Encode();
}

}  // namespace tessera
