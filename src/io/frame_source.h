// Frame sources: recorded folders, cameras, built-in scenes. A source delivers rectified,
// registered frames in metres, in order. Owner thread only; FrameReader (frame_reader.h) reads
// ahead on its own thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"
#include "core/status.h"

namespace tessera {

enum class ReadStatus {
    kOk,    // `frame` is filled
    kSkip,  // this frame is bad (message says why); the next Read returns the one after it
    // No frame yet; `frame` is unchanged. Call Read again. The message, if any, is for the user.
    kWait,
    kEnd,    // no more frames
    kError,  // the source has failed for good (message says why)
};

struct ReadResult {
    ReadStatus status = ReadStatus::kOk;
    // Names the file and what is wrong. Empty for kOk and kEnd, usually empty for kWait.
    std::string message;
};

struct SourceInfo {
    std::string name;          // as the user gave it
    std::string kind;          // "TUM folder", "synthetic scene", ...
    PinholeCamera camera;      // camera model of the delivered frames (after rectification)
    bool camera_known = true;  // false: camera unknown, `camera` is a guess
    // Where `camera` is from, or what the guess is: "camera.yaml", "the device", ...
    std::string camera_from = "the source";
    // False: depth and colour come from two cameras, and were brought into register by their known
    // calibration. One estimate for both would be wrong.
    bool one_camera = true;
    bool registration_known = true;  // false: how colour lies on depth is a guess
    std::int64_t frame_count = -1;   // number of pairs, -1 if not known beforehand
    double fps = 30;
    // A live device delivers frames at its own rate and drops those not read in time. Its Read
    // returns at least every half second, with kWait if there is no frame.
    bool live = false;
    // Units per metre of the source's own integer depth; depth_m is a multiple of this step.
    double depth_units_per_m = 5000;
    // Where a calibration of this very camera is looked for; "": nowhere.
    std::string calibration_file;
    // Read-out times of the images, as tracking has found them before; 0: not known.
    double depth_readout_s = 0, colour_readout_s = 0;
    bool rectified = false;       // a lens was corrected, or colour registered to depth
    bool lens_corrected = false;  // the former
    bool has_colour = true;       // false: no frame has colour; true: some may have
    bool has_truth = false;
    // Things the user should know: unpaired images, repeated stamps, ...
    std::vector<std::string> notes;
    // Signs that the source is not read as it was meant: most images unused, stamps that jump, ...
    std::vector<std::string> warnings;
};

class FrameSource {
  public:
    virtual ~FrameSource() = default;
    virtual const SourceInfo& info() const = 0;
    // Fills `frame` (its storage is reused). Never throws.
    virtual ReadResult Read(Frame& frame) = 0;
    // Makes the next Read return frame `index` of the source's list. Returns false if the source
    // cannot seek or the index is out of range.
    virtual bool Seek(std::int64_t index) = 0;
    // stamp_s of every frame, in Seek's order; empty where they are not known before reading.
    virtual std::vector<double> Stamps_s() const { return {}; }
    // Lets the source itself record everything it delivers into this .oni file, until it ends or is
    // unplugged. Call it before the first Read. Without `lossless_colour`, colour is stored as
    // JPEG, a tenth of the size; depth is always exact. Only OpenNI2 cameras support this. Others
    // return an error that says what to do (a FrameRecorder records any source).
    virtual Status RecordTo(const std::string& path, bool lossless_colour);
};

// A source that knows all its frames beforehand. Subclasses set info_ with its frame_count, and
// Read goes on at next_.
class ListedSource : public FrameSource {
  public:
    const SourceInfo& info() const final { return info_; }
    bool Seek(std::int64_t index) final {
        if (index < 0 || index > info_.frame_count) return false;
        next_ = index;
        return true;
    }

  protected:
    SourceInfo info_;
    std::int64_t next_ = 0;
};

// The part of a source to read.
struct FrameSelection {
    std::int64_t start = 0;   // first frame
    std::int64_t count = -1;  // how many frames to read, -1 = all
    std::int64_t stride = 1;  // take every stride-th
};

}  // namespace tessera
