#include "scan/scan_records.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

void PutCamera(const PinholeCamera& c, StateWriter& state) {
    state.Put(c.width);
    state.Put(c.height);
    for (const double value : {c.fx, c.fy, c.cx, c.cy}) state.Put(value);
}

bool GetCamera(StateReader& state, PinholeCamera& c) {
    constexpr int kMostSide_px = 65500;
    if (!state.Get(c.width) || !state.Get(c.height)) return false;
    for (double* value : {&c.fx, &c.fy, &c.cx, &c.cy})
        if (!state.Get(*value) || !std::isfinite(*value)) return false;
    return c.width > 0 && c.height > 0 && c.width <= kMostSide_px && c.height <= kMostSide_px &&
           c.fx > 0 && c.fy > 0;
}

}  // namespace

Bytes ScanMeta::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    for (const std::string& text : {program, source_name, source_kind}) state.Put(text);
    PutCamera(camera, state);
    for (const double value : {depth_units_per_m, voxel_size_m, truncation_m}) state.Put(value);
    state.Put(loops);
    state.Put(configuration);
    if (band_per_m > 0) state.Put(band_per_m);  // earlier programs have none
    return bytes;
}

bool ScanMeta::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    for (std::string* text : {&program, &source_name, &source_kind})
        if (!state.Get(*text)) return false;
    if (!GetCamera(state, camera)) return false;
    for (double* value : {&depth_units_per_m, &voxel_size_m, &truncation_m})
        if (!state.Get(*value) || !(*value > 0) || !std::isfinite(*value)) return false;
    if (!state.Get(loops) || !state.Get(configuration)) return false;
    band_per_m = 0;
    if (state.at_end()) return true;
    return state.Get(band_per_m) && band_per_m > 0 && std::isfinite(band_per_m) && state.at_end();
}

Bytes PathRecord::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(index);
    state.Put(stamp_s);
    state.Put(static_cast<std::uint8_t>(status));
    state.Put(fused);
    state.Put(keyframe);
    state.Put(T_reference_camera);
    state.Put(T_world_camera_truth);
    return bytes;
}

bool PathRecord::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    std::uint8_t status_number = 0;
    state.Get(index);
    state.Get(stamp_s);
    state.Get(status_number);
    state.Get(fused);
    state.Get(keyframe);
    state.Get(T_reference_camera);
    state.Get(T_world_camera_truth);
    status = static_cast<TrackStatus>(status_number);
    return state.at_end() && std::isfinite(stamp_s) &&
           status_number <= static_cast<int>(TrackStatus::kLost) && keyframe >= -1;
}

Bytes ScanProgress::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(frames);
    state.Put(fused_frames);
    state.Put(labelled_frames);
    state.Put(last_index);
    state.Put(last_stamp_s);
    state.Put(labels);
    return bytes;
}

bool ScanProgress::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    state.Get(frames);
    state.Get(fused_frames);
    state.Get(labelled_frames);
    state.Get(last_index);
    state.Get(last_stamp_s);
    state.Get(labels);
    return state.at_end() && frames >= 0 && labelled_frames >= 0 && std::isfinite(last_stamp_s);
}

}  // namespace tessera
