// Writes checkpoints: the changes since the previous one, as one transaction.
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

// A self-contained message; it shares no data with other objects. Keys are row keys.
struct ScanCheckpoint {
    bool clear_all = false;     // restart from an empty world; everything written before is invalid
    bool clear_blocks = false;  // replace the map: `stored` and `blocks` are all of it
    std::shared_ptr<const CubeScratch> stored;  // usually null; `blocks` are newer
    BlockCopies blocks;
    // New records, and those whose pose has been improved.
    std::vector<std::pair<std::int64_t, PathRecord>> path;
    std::vector<std::pair<std::int64_t, FrameRecord>> frames;
    // The writer compresses these. Must not also be in `frames`.
    std::vector<std::pair<std::int64_t, std::unique_ptr<Frame>>> raw_frames;
    std::vector<Keyframe> keyframes;  // new ones
    std::vector<std::pair<int, KeyframePoses>> poses;
    ScanProgress progress;
    std::string source;      // empty: keep what the file has
    Bytes tracking, labels;  // empty: keep what the file has
    std::optional<LoopProgress> loops;
    bool finished = false;

    // Prepares for reuse and keeps the storage.
    void Clear();
};

// Owner thread only.
class ScanWriter {
  public:
    ScanWriter(std::unique_ptr<ScanFile> file, double depth_units_per_m)
        : file_(std::move(file)), depth_units_per_m_(depth_units_per_m) {}

    // On error, the file stays valid as it was before, and nothing more should be written.
    Status Write(const ScanCheckpoint& checkpoint);
    void Close() { file_->Close(); }

  private:
    void PutRows(const ScanCheckpoint& checkpoint);
    Result<Bytes> Compress(const Frame& frame);

    std::unique_ptr<ScanFile> file_;
    double depth_units_per_m_;
    BlockCodec codec_;
    PngEncoder png_;
    Image<std::uint16_t> raw_depth_;
};

}  // namespace tessera
