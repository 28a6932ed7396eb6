// Records of frames and of the pose graph.
#include <algorithm>
#include <cmath>

#include "scan/scan_records.h"

namespace tessera {
namespace {

// At the end of a record. The ignored classes follow only if there are any: older programs wrote
// none.
void PutDetections(const std::optional<StoredDetections>& stored, StateWriter& state) {
    state.Put(stored.has_value());
    if (!stored) return;
    const std::vector<Detection> detections = stored->Unpack();
    state.Put(static_cast<std::uint32_t>(detections.size()));
    for (const Detection& d : detections) {
        state.Put(d.name);
        state.Put(static_cast<std::int32_t>(d.class_id));
        for (const float value :
             {d.probability, d.box.x_min, d.box.y_min, d.box.x_max, d.box.y_max})
            state.Put(value);
        state.Put(static_cast<std::int32_t>(d.mask.width()));
        state.PutArray(std::span<const std::uint8_t>(d.mask.data(), d.mask.size()));
    }
    std::vector<std::uint8_t> ignored;
    for (std::size_t id = 0; id < stored->ignored().size(); ++id)
        if (stored->ignored()[id]) ignored.push_back(static_cast<std::uint8_t>(id));
    if (!ignored.empty()) state.PutArray(std::span<const std::uint8_t>(ignored));
}

bool GetDetection(StateReader& state, Detection& d) {
    std::int32_t class_id = 0, mask_width = 0;
    std::vector<std::uint8_t> mask;
    state.Get(d.name);
    state.Get(class_id);
    for (float* value : {&d.probability, &d.box.x_min, &d.box.y_min, &d.box.x_max, &d.box.y_max})
        if (!state.Get(*value) || !std::isfinite(*value)) return false;
    state.Get(mask_width);
    if (!state.GetArray(mask) || class_id < 0 || class_id > LabelClasses::kMost) return false;
    d.class_id = class_id;
    if (mask.empty()) return true;
    if (mask_width <= 0 || mask.size() % static_cast<std::size_t>(mask_width) != 0) return false;
    d.mask.Resize(mask_width, static_cast<int>(mask.size() / static_cast<std::size_t>(mask_width)));
    std::ranges::copy(mask, d.mask.data());
    return true;
}

bool GetDetections(StateReader& state, std::optional<StoredDetections>& stored) {
    bool there = false;
    std::uint32_t count = 0;
    if (!state.Get(there)) return false;
    if (!there) return true;
    if (!state.Get(count)) return false;
    std::vector<Detection> detections;
    for (std::uint32_t i = 0; i < count; ++i)
        if (!GetDetection(state, detections.emplace_back())) return false;
    std::vector<std::uint8_t> ids;
    if (!state.at_end() && !state.GetArray(ids)) return false;
    ClassSet ignored;
    for (const std::uint8_t id : ids) {
        if (id > LabelClasses::kMost) return false;
        ignored.set(id);
    }
    stored.emplace(std::move(detections), ignored);
    return true;
}

void PutMotion(const FrameMotion& motion, StateWriter& state) {
    state.Put(motion.twist_per_s);
    for (const double value :
         {motion.colour_delay_s, motion.depth_readout_s, motion.colour_readout_s})
        state.Put(value);
}

bool GetMotion(StateReader& state, FrameMotion& motion) {
    if (!state.Get(motion.twist_per_s)) return false;
    for (double* value :
         {&motion.colour_delay_s, &motion.depth_readout_s, &motion.colour_readout_s})
        if (!state.Get(*value) || !std::isfinite(*value)) return false;
    return true;
}

}  // namespace

Result<Bytes> FrameRecord::Encode() const {
    const auto images = stored.images.Read();
    if (!images.ok()) return images.status();
    Bytes bytes;
    bytes.reserve(images.value()->bytes() + 512);
    StateWriter state(bytes);
    state.Put(index);
    state.Put(stamp_s);
    state.Put(colour_stamp_s);
    state.Put(in_store);
    state.Put(stored.ordinal);
    state.Put(stored.keyframe);
    state.Put(stored.is_keyframe);
    state.Put(stored.T_keyframe_camera);
    state.Put(stored.view.T_world_camera);
    PutMotion(stored.view.motion, state);
    for (const float value :
         {stored.view.gain, stored.view.offset, stored.view.weight, stored.view.colour_weight})
        state.Put(value);
    state.PutArray(std::span<const std::uint8_t>(images.value()->depth_png));
    state.PutArray(std::span<const std::uint8_t>(images.value()->colour_jpeg));
    PutDetections(stored.detections, state);
    return bytes;
}

bool FrameRecord::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    state.Get(index);
    state.Get(stamp_s);
    state.Get(colour_stamp_s);
    state.Get(in_store);
    state.Get(stored.ordinal);
    state.Get(stored.keyframe);
    state.Get(stored.is_keyframe);
    state.Get(stored.T_keyframe_camera);
    state.Get(stored.view.T_world_camera);
    if (!GetMotion(state, stored.view.motion)) return false;
    for (float* value :
         {&stored.view.gain, &stored.view.offset, &stored.view.weight, &stored.view.colour_weight})
        if (!state.Get(*value) || !std::isfinite(*value)) return false;
    EncodedImages images;
    state.GetArray(images.depth_png);
    state.GetArray(images.colour_jpeg);
    stored.images = StoredImages(std::move(images));
    stored.frame_index = index;
    if (!GetDetections(state, stored.detections)) return false;
    return state.at_end() && std::isfinite(stamp_s) && std::isfinite(colour_stamp_s) &&
           stored.ordinal >= 0 && stored.keyframe >= 0;
}

Bytes KeyframePoses::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(T_map_camera);
    state.Put(T_world_camera);
    return bytes;
}

bool KeyframePoses::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    return state.Get(T_map_camera) && state.Get(T_world_camera) && state.at_end();
}

Bytes LoopProgress::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(next_ordinal);
    state.Put(loops);
    state.Put(corrected);
    state.Put(static_cast<std::uint64_t>(edges.size()));
    for (const PoseEdge& edge : edges) {
        state.Put(edge.from);
        state.Put(edge.to);
        state.Put(edge.T_from_to);
        state.Put(edge.root_information);
        state.Put(edge.loop);
    }
    return bytes;
}

bool LoopProgress::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    std::uint64_t count = 0;
    state.Get(next_ordinal);
    state.Get(loops);
    state.Get(corrected);
    state.Get(count);
    edges.clear();
    // Format 1 had two standard deviations instead of a matrix.
    constexpr std::size_t kHeader = 21, kEdgeOfFormat1 = 153;
    const bool format1 = bytes.size() >= kHeader &&
                         (bytes.size() - kHeader) / kEdgeOfFormat1 == count &&
                         (bytes.size() - kHeader) % kEdgeOfFormat1 == 0;
    for (; state.ok() && count > 0; --count) {
        PoseEdge edge;
        state.Get(edge.from);
        state.Get(edge.to);
        state.Get(edge.T_from_to);
        if (format1) {
            double sigma_m = 0, sigma_rad = 0;
            state.Get(sigma_m);
            state.Get(sigma_rad);
            if (!(sigma_m > 0) || !(sigma_rad > 0)) return false;
            edge.root_information = RootInformation(sigma_rad, sigma_m);
            if (!edge.root_information.allFinite()) return false;
        } else {
            state.Get(edge.root_information);
        }
        state.Get(edge.loop);
        if (!state.ok()) return false;
        edges.push_back(edge);
    }
    return state.at_end() && next_ordinal >= 0 && loops >= 0;
}

}  // namespace tessera
