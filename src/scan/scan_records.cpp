#include "scan/scan_records.h"

#include <cmath>

namespace tessera {
namespace {

// The fields of each record in the order of their bytes. Of a const record they can only be
// written.
auto MetaFields(auto& meta) {
    auto& c = meta.camera;
    return std::tie(meta.program, meta.source_name, meta.source_kind, c.width, c.height, c.fx, c.fy,
                    c.cx, c.cy, meta.depth_units_per_m, meta.voxel_size_m, meta.truncation_m,
                    meta.loops, meta.configuration);
}

// The status is one byte.
auto PathFields(auto& record, auto& status) {
    return std::tie(record.index, record.stamp_s, status, record.fused, record.keyframe,
                    record.T_reference_camera, record.T_world_camera_truth);
}

auto ProgressFields(auto& progress) {
    return std::tie(progress.frames, progress.fused_frames, progress.labelled_frames,
                    progress.last_index, progress.last_stamp_s, progress.labels);
}

bool IsPossible(const PinholeCamera& c) {
    constexpr int kMostSide_px = 65500;
    return c.width > 0 && c.height > 0 && c.width <= kMostSide_px && c.height <= kMostSide_px &&
           c.fx > 0 && c.fy > 0;
}

}  // namespace

Bytes ScanMeta::Encode() const {
    Bytes bytes = Encoded(MetaFields(*this));
    if (band_per_m > 0) StateWriter(bytes).Put(band_per_m);  // earlier programs have none
    return bytes;
}

bool ScanMeta::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    if (!state.Get(MetaFields(*this)) || !AllFinite(MetaFields(*this)) || !IsPossible(camera) ||
        !(depth_units_per_m > 0 && voxel_size_m > 0 && truncation_m > 0))
        return false;
    band_per_m = 0;
    if (state.at_end()) return true;
    return state.Get(band_per_m) && band_per_m > 0 && std::isfinite(band_per_m) && state.at_end();
}

Bytes PathRecord::Encode() const {
    const auto status_number = static_cast<std::uint8_t>(status);
    return Encoded(PathFields(*this, status_number));
}

bool PathRecord::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    std::uint8_t status_number = 0;
    state.Get(PathFields(*this, status_number));
    status = static_cast<TrackStatus>(status_number);
    return state.at_end() && AllFinite(PathFields(*this, status_number)) &&
           status_number <= static_cast<int>(TrackStatus::kLost) && keyframe >= -1;
}

Bytes ScanProgress::Encode() const { return Encoded(ProgressFields(*this)); }

bool ScanProgress::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    state.Get(ProgressFields(*this));
    return state.at_end() && AllFinite(ProgressFields(*this)) && frames >= 0 &&
           labelled_frames >= 0;
}

}  // namespace tessera
