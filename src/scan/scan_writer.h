// Writes checkpoints: what changed since the one before, as one transaction.
#pragma once

#include <memory>
#include <optional>

#include "core/frame.h"
#include "io/png_encoder.h"
#include "scan/block_codec.h"
#include "scan/cube_scratch.h"
#include "scan/scan_file.h"
#include "scan/scan_records.h"

namespace tessera {

// As a message: nothing in it belongs to anyone else. Keys are those of the rows.
struct ScanCheckpoint {
    bool clear_all = false;     // a new world: nothing that was written before holds
    bool clear_blocks = false;  // another map: `stored` and `blocks` are all of it
    std::shared_ptr<const CubeScratch> stored;  // mostly null; `blocks` are newer
    BlockCopies blocks;
    // New ones, and those whose place is known better now.
    std::vector<std::pair<std::int64_t, PathRecord>> path;
    std::vector<std::pair<std::int64_t, FrameRecord>> frames;
    // To be compressed by the writer; not also in `frames`.
    std::vector<std::pair<std::int64_t, std::unique_ptr<Frame>>> raw_frames;
    std::vector<Keyframe> keyframes;  // new ones
    std::vector<std::pair<int, KeyframePoses>> poses;
    ScanProgress progress;
    Bytes tracking, labels;  // empty: as the file has it
    std::optional<LoopProgress> loops;
    bool finished = false;

    // For the next one; storage is kept.
    void Clear();
};

// Owner thread only.
class ScanWriter {
  public:
    ScanWriter(std::unique_ptr<ScanFile> file, double depth_units_per_m)
        : file_(std::move(file)), depth_units_per_m_(depth_units_per_m) {}

    // After an error the file is as it was before, and sound; nothing more should be written.
    Status Write(const ScanCheckpoint& checkpoint);
    void Close() { file_->Close(); }
    const ScanFile& file() const { return *file_; }

  private:
    Status PutRows(const ScanCheckpoint& checkpoint);
    Status PutState(ScanStateKey key, const Bytes& bytes);
    Result<FrameRecord> Compress(const Frame& frame);

    std::unique_ptr<ScanFile> file_;
    double depth_units_per_m_;
    BlockCodec codec_;
    std::vector<std::pair<std::int64_t, std::size_t>> order_;
    PngEncoder png_;
    Image<std::uint16_t> raw_depth_;
};

}  // namespace tessera
