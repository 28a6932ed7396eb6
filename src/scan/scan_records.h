// Contents and encoding of the rows of a scan file, except for blocks. Decode functions return
// false for bytes that are not a valid record. They trust nothing in the data and allocate no more
// than the bytes present.
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

// Properties that do not change during a scan.
struct ScanMeta {
    std::string program;  // version that started the scan
    std::string source_name, source_kind;
    PinholeCamera camera;
    double depth_units_per_m = 5000;
    double voxel_size_m = 0, truncation_m = 0, band_per_m = 0;
    bool loops = false;         // loop closure is on: keyframes and frames are stored
    std::string configuration;  // the complete configuration as YAML

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// One frame that was tracked or should have been. Its row's key counts these frames from 0.
struct PathRecord {
    std::int64_t index = 0;  // in its source
    double stamp_s = 0;
    TrackStatus status = TrackStatus::kLost;
    bool fused = false;
    // With loop closure, the keyframe to which T_reference_camera is relative; -1: relative to the
    // world.
    std::int32_t keyframe = -1;
    Eigen::Isometry3d T_reference_camera = Eigen::Isometry3d::Identity();  // identity if lost
    std::optional<Eigen::Isometry3d> T_world_camera_truth;                 // in the source's world

    bool tracked() const { return status != TrackStatus::kLost; }
    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// State as of the last frame of a checkpoint.
struct ScanProgress {
    std::int64_t frames = 0;  // number of frames on the path
    // Frames fused into the map, not counting corrections. Seeds the map's dither.
    std::uint32_t fused_frames = 0;
    std::int64_t labelled_frames = 0;  // frames offered to the detector
    std::int64_t last_index = -1;
    double last_stamp_s = 0;
    bool labels = false;  // blocks have labels

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

// A raw frame. Its row's key is that of its frame on the path.
struct FrameRecord {
    std::int64_t index = 0;
    double stamp_s = 0, colour_stamp_s = 0;
    // True: in FrameStore, and all of `stored` is valid. False: only its images are valid.
    bool in_store = false;
    StoredFrame stored;

    // Returns an error if the images cannot be read from their temporary file.
    Result<Bytes> Encode() const;
    // Does not decode the images, and leaves them in memory.
    bool Decode(std::span<const std::uint8_t> bytes);
};

// The poses of a keyframe, which change with each loop closure.
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

// Everything in a keyframe except its two poses and `view`, which follows from the camera.
Bytes EncodeKeyframe(const Keyframe& keyframe);
bool DecodeKeyframe(std::span<const std::uint8_t> bytes, const PinholeCamera& camera,
                    Keyframe& keyframe);

// LoopCloser's state besides keyframes, frames and passages.
struct LoopProgress {
    std::vector<PoseEdge> edges;
    // Next ordinal of the frame store. The scan may have newer frames.
    std::int64_t next_ordinal = 0;
    std::int32_t loops = 0;
    bool corrected = false;

    Bytes Encode() const;
    bool Decode(std::span<const std::uint8_t> bytes);
};

}  // namespace tessera
