// The frames that the map was made of, compressed in memory, each with its place relative to a
// keyframe: what it takes to make the map again when the keyframes have moved.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/frame_motion.h"
#include "core/status.h"
#include "io/png_decoder.h"
#include "io/png_encoder.h"
#include "mapping/integrator.h"
#include "semantics/detector.h"

namespace tessera {

struct StoredFrame {
    std::int64_t ordinal = 0;  // among all frames ever added, from 0
    int keyframe = 0;
    bool is_keyframe = false;  // the keyframe's own: never thinned out
    Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
    Integrator::View view;  // as it was fused, but for the pose
    double stamp_s = 0, colour_stamp_s = 0;
    std::vector<std::uint8_t> depth_png, colour_jpeg;  // the latter empty without colour
    std::int64_t frame_index = 0;
    // As they were voted into the map; nothing if it was not looked at.
    std::optional<std::vector<Detection>> detections;

    std::size_t bytes() const {
        return sizeof(StoredFrame) + depth_png.capacity() + colour_jpeg.capacity();
    }
};

// Owner thread only.
class FrameStore {
  public:
    // Over the limit every second frame is let go, then every second of the rest, and so on: what
    // is left is spread over the whole scan. Depth is kept in steps of 1 / `depth_units_per_m`,
    // colour as JPEG.
    FrameStore(std::size_t limit_bytes, double depth_units_per_m)
        : limit_bytes_(limit_bytes), depth_units_per_m_(depth_units_per_m) {}

    // `T_keyframe_camera` is the identity for the keyframe's own frame. Errors: what the encoder
    // refuses.
    Status Add(const Frame& frame, int keyframe, bool is_keyframe,
               const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    // To a frame added before, by this process, if it is still there.
    void AddDetections(std::int64_t frame_index, std::vector<Detection> detections);
    // Before the first Add: goes on with frames of an earlier one, by increasing ordinal.
    void Resume(std::vector<StoredFrame> frames, std::int64_t next_ordinal);
    // Index (the ordinal), colour and depth, into storage that is used again; the rest of `frame`
    // stays.
    Status Load(const StoredFrame& stored, Frame& frame);
    // The same made ready for tracking and fusion. Frames of an earlier process may be damaged:
    // errors are what the decoders refuse, and images of another size than the camera's.
    Status LoadPrepared(const StoredFrame& stored, const PinholeCamera& camera,
                        const PreparedFrame::Config& preparation, Frame& frame,
                        PreparedFrame& prepared);

    // A frame added by this process, by its index; null if it is not kept.
    const StoredFrame* Find(std::int64_t frame_index) const;
    // By increasing ordinal.
    const std::vector<StoredFrame>& frames() const { return frames_; }
    std::int64_t next_ordinal() const { return next_ordinal_; }
    std::size_t bytes() const { return bytes_; }
    int stride() const { return stride_; }  // of the ordinals kept: 1 until the limit was reached

  private:
    void Thin();

    std::size_t limit_bytes_, bytes_ = 0;
    double depth_units_per_m_;
    std::int64_t next_ordinal_ = 0;
    std::int64_t first_own_ = 0;  // ordinal: what is before it was resumed; a source may count anew
    int stride_ = 1;
    std::vector<StoredFrame> frames_;
    PngEncoder encoder_;
    PngDecoder decoder_;
    Image<std::uint16_t> raw_depth_;
};

}  // namespace tessera
