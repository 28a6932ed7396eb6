// Records of frames and of the pose graph.
#include <algorithm>

#include "scan/scan_records.h"

namespace tessera {
namespace {

// The fields in the order of their bytes, as in scan_records.cpp.
auto FrameFields(auto& record) {
    auto& stored = record.stored;
    auto& view = stored.view;
    auto& motion = view.motion;
    return std::tie(record.index, record.stamp_s, record.colour_stamp_s, record.in_store,
                    stored.ordinal, stored.keyframe, stored.is_keyframe, stored.T_keyframe_camera,
                    view.T_world_camera, motion.twist_per_s, motion.colour_delay_s,
                    motion.depth_readout_s, motion.colour_readout_s, view.gain, view.offset,
                    view.weight, view.colour_weight);
}

auto ImageFields(auto& images) { return std::tie(images.depth_png, images.colour_jpeg); }

// The mask's pixels follow.
auto DetectionFields(auto& d, auto& mask_width) {
    return std::tie(d.name, d.class_id, d.probability, d.box.x_min, d.box.y_min, d.box.x_max,
                    d.box.y_max, mask_width);
}

auto PosesFields(auto& poses) { return std::tie(poses.T_map_camera, poses.T_world_camera); }

auto LoopFields(auto& progress) {
    return std::tie(progress.next_ordinal, progress.loops, progress.corrected);
}

auto EdgeFields(auto& edge) {
    return std::tie(edge.from, edge.to, edge.T_from_to, edge.root_information, edge.loop);
}

// At the end of a record. The ignored classes follow only if there are any: older programs wrote
// none.
void PutDetections(const std::optional<StoredDetections>& stored, StateWriter& state) {
    state.Put(stored.has_value());
    if (!stored) return;
    const std::vector<Detection> detections = stored->Unpack();
    state.Put(static_cast<std::uint32_t>(detections.size()));
    for (const Detection& d : detections) {
        const int mask_width = d.mask.width();
        state.Put(DetectionFields(d, mask_width));
        state.PutArray(std::span<const std::uint8_t>(d.mask.data(), d.mask.size()));
    }
    std::vector<std::uint8_t> ignored;
    for (std::size_t id = 0; id < stored->ignored().size(); ++id)
        if (stored->ignored()[id]) ignored.push_back(static_cast<std::uint8_t>(id));
    if (!ignored.empty()) state.Put(ignored);
}

bool GetDetection(StateReader& state, Detection& d) {
    int mask_width = 0;
    std::vector<std::uint8_t> mask;
    if (!state.Get(DetectionFields(d, mask_width)) || !AllFinite(DetectionFields(d, mask_width)) ||
        !state.Get(mask) || d.class_id < 0 || d.class_id > LabelClasses::kMost)
        return false;
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
    if (!state.at_end() && !state.Get(ids)) return false;
    ClassSet ignored;
    for (const std::uint8_t id : ids) {
        if (id > LabelClasses::kMost) return false;
        ignored.set(id);
    }
    stored.emplace(std::move(detections), ignored);
    return true;
}

}  // namespace

Result<Bytes> FrameRecord::Encode() const {
    const auto images = stored.images.Read();
    if (!images.ok()) return images.status();
    Bytes bytes;
    bytes.reserve(images.value()->bytes() + 512);
    StateWriter state(bytes);
    state.Put(FrameFields(*this));
    state.Put(ImageFields(*images.value()));
    PutDetections(stored.detections, state);
    return bytes;
}

bool FrameRecord::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    EncodedImages images;
    if (!state.Get(FrameFields(*this)) || !state.Get(ImageFields(images))) return false;
    stored.images = StoredImages(std::move(images));
    stored.frame_index = index;
    if (!GetDetections(state, stored.detections)) return false;
    return state.at_end() && AllFinite(FrameFields(*this)) && stored.ordinal >= 0 &&
           stored.keyframe >= 0;
}

Bytes KeyframePoses::Encode() const { return Encoded(PosesFields(*this)); }

bool KeyframePoses::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    return state.Get(PosesFields(*this)) && state.at_end();
}

Bytes LoopProgress::Encode() const {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(LoopFields(*this));
    state.Put(static_cast<std::uint64_t>(edges.size()));
    for (const PoseEdge& edge : edges) state.Put(EdgeFields(edge));
    return bytes;
}

bool LoopProgress::Decode(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    std::uint64_t count = 0;
    state.Get(LoopFields(*this));
    state.Get(count);
    edges.clear();
    // Format 1 had two standard deviations instead of a matrix.
    constexpr std::size_t kHeader = 21, kEdgeOfFormat1 = 153;
    const bool format1 = bytes.size() >= kHeader &&
                         (bytes.size() - kHeader) / kEdgeOfFormat1 == count &&
                         (bytes.size() - kHeader) % kEdgeOfFormat1 == 0;
    for (; state.ok() && count > 0; --count) {
        PoseEdge edge;
        if (format1) {
            double sigma_m = 0, sigma_rad = 0;
            state.Get(std::tie(edge.from, edge.to, edge.T_from_to, sigma_m, sigma_rad, edge.loop));
            if (!(sigma_m > 0) || !(sigma_rad > 0)) return false;
            edge.root_information = RootInformation(sigma_rad, sigma_m);
            if (!edge.root_information.allFinite()) return false;
        } else {
            state.Get(EdgeFields(edge));
        }
        if (!state.ok()) return false;
        edges.push_back(edge);
    }
    return state.at_end() && next_ordinal >= 0 && loops >= 0;
}

}  // namespace tessera
