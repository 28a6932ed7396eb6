// What the rows of a scan file besides the blocks say, and their bytes. Decode functions are false
// for bytes that are no such record; they believe nothing and allocate no more than the bytes that
// are there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/state_stream.h"
#include "optimize/frame_store.h"
#include "optimize/keyframe.h"
#include "optimize/pose_graph.h"
#include "tracking/tracker.h"

namespace tessera {

using Bytes = std::vector<std::uint8_t>;

// What does not change while a scan is made.
struct ScanMeta {
    std::string program;  // version that began it
    std::string source_name, source_kind;
    PinholeCamera camera;
    double depth_units_per_m = 5000;
    double voxel_size_m = 0, truncation_m = 0;
    bool loops = false;         // loop closure is on: keyframes and frames are there
    std::string configuration;  // YAML, the whole of it

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// One frame that was tracked, or was to be: the key of its row counts them from 0.
struct PathRecord {
    std::int64_t index = 0;  // in its source
    double stamp_s = 0;
    TrackStatus status = TrackStatus::kLost;
    bool fused = false;
    // With loop closure: T_reference_camera is relative to it; -1: to the world.
    std::int32_t keyframe = -1;
    Eigen::Isometry3d T_reference_camera = Eigen::Isometry3d::Identity();  // identity if lost
    std::optional<Eigen::Isometry3d> T_world_camera_truth;                 // in the source's world

    bool tracked() const { return status != TrackStatus::kLost; }
    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// As of the last frame of a checkpoint.
struct ScanProgress {
    std::int64_t frames = 0;  // of the path
    // That the map has seen, corrections apart: what its dither counts.
    std::uint32_t fused_frames = 0;
    std::int64_t labelled_frames = 0;  // that were offered to the detector
    std::int64_t last_index = -1;
    double last_stamp_s = 0;
    bool labels = false;  // blocks have labels

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// A raw frame. The key of its row is its frame's on the path.
struct FrameRecord {
    std::int64_t index = 0;
    double stamp_s = 0, colour_stamp_s = 0;
    bool in_store = false;  // one of FrameStore's: all of `stored` holds; else only its images
    StoredFrame stored;

    Bytes Encode() const;
    // Images are not decoded, only taken apart.
    bool Decode(std::span<const std::uint8_t> bytes);
};

// Where a keyframe lies, which changes with each loop.
struct KeyframePoses {
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity(),
                      T_world_camera = Eigen::Isometry3d::Identity();

    bool operator==(const KeyframePoses& other) const {
        return T_map_camera.matrix() == other.T_map_camera.matrix() &&
               T_world_camera.matrix() == other.T_world_camera.matrix();
    }
    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// All of a keyframe but its two poses, and but `view`, which follows from the camera.
Bytes EncodeKeyframe(const Keyframe& keyframe);
bool DecodeKeyframe(std::span<const std::uint8_t> bytes, const PinholeCamera& camera,
                    Keyframe& keyframe);

// What LoopCloser knows besides keyframes, frames and passages.
struct LoopProgress {
    std::vector<PoseEdge> edges;
    std::int64_t next_ordinal = 0;  // of the frame store
    std::int32_t loops = 0;
    bool corrected = false;

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

}  // namespace tessera
