// Records of keyframes.
#include <algorithm>
#include <cmath>

#include "scan/scan_records.h"

namespace tessera {
namespace {

// The fields in the order of their bytes, as in scan_records.cpp. The others are arrays of another
// type, or missing in format 1.
auto KeyframeFields(auto& keyframe) {
    return std::tie(keyframe.frame_index, keyframe.stamp_s, keyframe.path_length_m,
                    keyframe.turned_rad, keyframe.inlier_fraction, keyframe.features.descriptors);
}

auto SkewFields(auto& keyframe) { return std::tie(keyframe.skew_m, keyframe.skew_rad); }

auto OverlapFields(auto& overlap) {
    return std::tie(overlap.with, overlap.T_with_this_aligned, overlap.information,
                    overlap.T_with_this_tracked);
}

bool GetReduced(StateReader& state, const PinholeCamera& camera, ReducedView& reduced) {
    std::int32_t reduction = 0;
    std::vector<std::uint16_t> depth;
    std::vector<std::uint8_t> luma;
    if (!state.Get(reduction) || !state.Get(depth) || !state.Get(luma) || reduction < 1)
        return false;
    reduced.reduction = reduction;
    const int width = camera.width / reduction, height = camera.height / reduction;
    if (depth.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) ||
        (!luma.empty() && luma.size() != depth.size()))
        return false;
    reduced.depth.Resize(width, height);
    std::ranges::copy(depth, reduced.depth.data());
    if (luma.empty()) return true;
    reduced.luma.Resize(width, height);
    std::ranges::copy(luma, reduced.luma.data());
    return true;
}

bool GetOverlaps(StateReader& state, std::vector<Overlap>& overlaps) {
    std::uint64_t count = 0;
    state.Get(count);
    for (; state.ok() && count > 0; --count) {
        Overlap overlap;
        if (!state.Get(OverlapFields(overlap)) || overlap.with < 0) return false;
        overlaps.push_back(overlap);
    }
    return state.ok();
}

}  // namespace

Bytes EncodeKeyframe(const Keyframe& keyframe) {
    Bytes bytes = Encoded(KeyframeFields(keyframe));
    StateWriter state(bytes);
    static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
    state.PutArray(std::span<const float>(
        keyframe.features.p_camera.empty() ? nullptr : keyframe.features.p_camera[0].data(),
        3 * keyframe.features.p_camera.size()));
    state.PutArray(std::span<const float>(keyframe.depth_m.data(), keyframe.depth_m.size()));
    const ReducedView& reduced = keyframe.reduced;
    state.Put(static_cast<std::int32_t>(reduced.reduction));
    state.PutArray(std::span<const std::uint16_t>(reduced.depth.data(), reduced.depth.size()));
    state.PutArray(std::span<const std::uint8_t>(reduced.luma.data(), reduced.luma.size()));
    state.Put(SkewFields(keyframe));
    state.Put(static_cast<std::uint64_t>(keyframe.overlaps.size()));
    for (const Overlap& overlap : keyframe.overlaps) state.Put(OverlapFields(overlap));
    return bytes;
}

bool DecodeKeyframe(std::span<const std::uint8_t> bytes, const PinholeCamera& camera,
                    Keyframe& keyframe) {
    StateReader state(bytes);
    std::vector<float> points, depth;
    if (!state.Get(KeyframeFields(keyframe)) || !AllFinite(KeyframeFields(keyframe)) ||
        !state.Get(points) || !state.Get(depth))
        return false;
    keyframe.view = camera.Every(kKeyframeReduction);
    keyframe.depth_m.Resize(keyframe.view.width, keyframe.view.height);
    keyframe.overlaps.clear();
    keyframe.reduced = {};
    const bool format1 = state.at_end();  // had neither view nor overlaps
    if (!format1 && (!GetReduced(state, camera, keyframe.reduced) ||
                     !state.Get(SkewFields(keyframe)) || !GetOverlaps(state, keyframe.overlaps)))
        return false;
    if (!state.at_end() || points.size() != 3 * keyframe.features.size() ||
        depth.size() != keyframe.depth_m.size())
        return false;
    for (const std::vector<float>* values : {&points, &depth})
        for (const float value : *values)
            if (!std::isfinite(value)) return false;
    keyframe.features.p_camera.clear();
    for (std::size_t i = 0; i < points.size(); i += 3)
        keyframe.features.p_camera.emplace_back(points[i], points[i + 1], points[i + 2]);
    std::copy(depth.begin(), depth.end(), keyframe.depth_m.data());
    return true;
}

}  // namespace tessera
