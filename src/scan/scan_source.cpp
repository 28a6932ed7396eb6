#include "scan/scan_source.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera {

ScanSource::ScanSource(std::unique_ptr<ScanFile> file, const ScanContent& content)
    : file_(std::move(file)), decoder_(0, content.meta.depth_units_per_m), path_(content.path) {
    info_.name = file_->path();
    info_.kind = "frames of a scan of " + content.meta.source_name;
    info_.camera = content.meta.camera;
    info_.depth_units_per_m = content.meta.depth_units_per_m;
    info_.rectified = true;
}

Result<std::unique_ptr<FrameSource>> ScanSource::Open(const std::string& path) {
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(path);
    if (!file.ok()) return file.status();
    Result<ScanContent> content = ReadScan(*file.value(), {.map = false});
    if (!content.ok()) return content.status();
    std::unique_ptr<ScanSource> source(new ScanSource(std::move(file.value()), content.value()));
    const auto frames = static_cast<std::int64_t>(source->path_.size());
    Status checked = source->file_->Read(ScanTable::kFrames, [&](const ScanRow& row) {
        if (row.key < 0 || row.key >= frames)
            return DamagedScan(path, fmt::format("frames {}", row.key));
        source->keys_.push_back(row.key);
        return Status::Ok();
    });
    if (!checked.ok()) return checked;
    const std::vector<std::int64_t>& keys = source->keys_;
    if (keys.empty())
        return Status::Error(
            path +
            ": contains no raw frames to replay; scan with --set scan.frames=all to "
            "keep them (tessera export, tessera info and --resume read the scan "
            "itself)");
    const auto record = [&](std::int64_t key) -> const PathRecord& {
        return source->path_[static_cast<std::size_t>(key)];
    };
    const double span_s = record(keys.back()).stamp_s - record(keys.front()).stamp_s;
    source->info_.frame_count = static_cast<std::int64_t>(keys.size());
    if (keys.size() > 1 && span_s > 0)
        source->info_.fps = static_cast<double>(keys.size() - 1) / span_s;
    source->info_.has_truth = std::ranges::any_of(
        keys, [&](std::int64_t key) { return record(key).T_world_camera_truth.has_value(); });
    if (static_cast<std::int64_t>(keys.size()) < frames)
        source->info_.notes.push_back(
            fmt::format("{} of the scan's {} frames are in the file", keys.size(), frames));
    source->FindReadouts();
    return std::unique_ptr<FrameSource>(std::move(source));
}

// Frames that are kept for corrected maps have them.
void ScanSource::FindReadouts() {
    constexpr std::size_t kMostTried = 200;
    FrameRecord record;
    for (std::size_t i = keys_.size(); i-- > 0 && keys_.size() - i <= kMostTried;) {
        const Result<Bytes> bytes = file_->ReadOne(ScanTable::kFrames, keys_[i]);
        if (!bytes.ok() || !record.Decode(bytes.value()) || !record.in_store) continue;
        info_.depth_readout_s = record.stored.view.motion.depth_readout_s;
        info_.colour_readout_s = record.stored.view.motion.colour_readout_s;
        return;
    }
}

ReadResult ScanSource::Read(Frame& frame) {
    if (next_ == info_.frame_count) return {ReadStatus::kEnd, {}};
    const std::int64_t position = next_++;
    const std::int64_t key = keys_[static_cast<std::size_t>(position)];
    const auto bad = [&](const std::string& why) {
        return ReadResult{ReadStatus::kSkip, fmt::format("{}: frame {}: {}", info_.name, key, why)};
    };
    const Result<Bytes> bytes = file_->ReadOne(ScanTable::kFrames, key);
    FrameRecord record;
    if (!bytes.ok() || !record.Decode(bytes.value())) return bad("is damaged");
    if (Status status = decoder_.Load(record.stored, frame); !status.ok())
        return bad(status.message());
    const PinholeCamera& c = info_.camera;
    if (frame.depth_m.width() != c.width || frame.depth_m.height() != c.height ||
        (!frame.colour.empty() &&
         (frame.colour.width() != c.width || frame.colour.height() != c.height)))
        return bad("does not have the camera's size");
    frame.index = position;
    frame.stamp_s = record.stamp_s;
    frame.colour_stamp_s = record.colour_stamp_s;
    frame.T_world_camera = path_[static_cast<std::size_t>(key)].T_world_camera_truth;
    return {};
}

std::vector<double> ScanSource::Stamps_s() const {
    std::vector<double> stamps_s;
    for (const std::int64_t key : keys_)
        stamps_s.push_back(path_[static_cast<std::size_t>(key)].stamp_s);
    return stamps_s;
}

}  // namespace tessera
