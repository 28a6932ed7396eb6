// The frames fused into the map, compressed, each with its pose relative to a keyframe: alone, or
// averaged with its neighbours. The map is rebuilt from them when keyframes have moved.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/frame_motion.h"
#include "core/status.h"
#include "io/png_decoder.h"
#include "io/png_encoder.h"
#include "mapping/integrator.h"
#include "optimize/frame_average.h"
#include "optimize/stored_detections.h"
#include "optimize/stored_images.h"
#include "semantics/detector.h"
#include "semantics/label_config.h"

namespace tessera {

struct StoredFrame {
    std::int64_t ordinal = 0;  // index among all frames ever added, from 0
    int keyframe = 0;
    bool is_keyframe = false;  // the frame of the keyframe itself; never thinned out
    Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
    Integrator::View view;  // as it was fused, except for the pose
    double stamp_s = 0, colour_stamp_s = 0;
    StoredImages images;
    std::int64_t frame_index = 0;
    // As voted into the map; empty if the detector did not process the frame.
    std::optional<StoredDetections> detections;

    std::size_t memory_bytes() const {
        return sizeof(StoredFrame) + images.memory_bytes() +
               (detections ? detections->memory_bytes() : 0);
    }
};

// Owner thread only.
class FrameStore {
  public:
    // Images are kept in `scratch`. Those that it leaves in memory count towards the limit, and so
    // do the detections. Above it every second frame is dropped, then every second of the rest, and
    // so on, so that the remaining frames cover the whole scan. Depth is stored in steps of 1 /
    // `depth_units_per_m`, colour as JPEG.
    FrameStore(std::size_t memory_limit_bytes, double depth_units_per_m,
               ImageScratch scratch = ImageScratch())
        : limit_bytes_(memory_limit_bytes),
          depth_units_per_m_(depth_units_per_m),
          scratch_(std::move(scratch)) {}

    // `T_keyframe_camera` is the identity for the frame of the keyframe. Colour that the view does
    // not fuse is not kept. Returns errors of the encoder.
    Status Add(const Frame& frame, int keyframe, bool is_keyframe,
               const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    // For a frame that may be averaged with its neighbours, all of one camera. The average is
    // stored when a frame comes that is not part of it.
    Status AddAveraged(const Frame& frame, const PinholeCamera& camera, int keyframe,
                       const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    // Stores the average of the latest frames, too, so that the store has all of them.
    void StoreLatest();
    // Adds detections to a frame that this process added, if it is still stored. `ignored`: classes
    // whose detections were dropped.
    void AddDetections(std::int64_t frame_index, std::vector<Detection> detections,
                       const ClassSet& ignored = {});
    // Before the first Add: continues with the frames of an earlier process, sorted by ordinal.
    void Resume(std::vector<StoredFrame> frames, std::int64_t next_ordinal);
    // Loads index (the ordinal), colour and depth. Reuses the storage of `frame` and leaves its
    // other fields unchanged.
    Status Load(const StoredFrame& stored, Frame& frame);
    // The same for colour and depth alone.
    Status Decode(const EncodedImages& images, Frame& frame);
    // Loads the frame and prepares it for tracking and fusion. Frames of an earlier process may be
    // damaged: returns decoder errors, and an error if the image size differs from the camera's.
    Status LoadPrepared(const StoredFrame& stored, const PinholeCamera& camera,
                        const PreparedFrame::Config& preparation, Frame& frame,
                        PreparedFrame& prepared);

    // Finds a frame added by this process by its index; null if it is not stored.
    const StoredFrame* Find(std::int64_t frame_index) const;
    // Sorted by ordinal.
    const std::vector<StoredFrame>& frames() const { return frames_; }
    std::int64_t next_ordinal() const { return next_ordinal_; }
    std::size_t memory_bytes() const { return bytes_; }
    // Returns once why frames are missing, or why images are kept in memory; usually empty.
    std::string TakeTrouble();
    // Of the stored ordinals; 1 until the limit is first reached.
    int stride() const { return stride_; }

  private:
    Status Store(const Frame& frame, int keyframe, bool is_keyframe,
                 const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    Status StoreAverage();
    void ThinToLimit();
    void Thin();
    Status DecodeDepth(const std::vector<std::uint8_t>& png, DepthImage& depth_m);

    std::size_t limit_bytes_, bytes_ = 0;
    double depth_units_per_m_;
    ImageScratch scratch_;
    FrameAverage average_;  // of the latest frames, not stored yet
    int keyframe_ = 0;      // of the average
    std::string trouble_;
    std::int64_t next_ordinal_ = 0;
    // First ordinal of this process; earlier frames were resumed, and their frame indices may
    // repeat.
    std::int64_t first_own_ = 0;
    int stride_ = 1;
    std::vector<StoredFrame> frames_;
    PngEncoder encoder_;
    PngDecoder decoder_;
    Image<std::uint16_t> raw_depth_;
};

}  // namespace tessera
