// Where frames come from: recorded folders, cameras, built-in scenes. A source hands out rectified,
// registered frames in metres, in order. Owner thread only; FrameReader (frame_reader.h) runs one
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
    kSkip,  // this frame is bad (message says why); the next Read gives the one after it
    // Nothing yet: no frame, `frame` as it was; Read again (message, if any, is for a person).
    kWait,
    kEnd,    // no more frames
    kError,  // the source is broken for good (message says why)
};

struct ReadResult {
    ReadStatus status = ReadStatus::kOk;
    // Names the file and what is wrong; empty when kOk or kEnd, mostly when kWait.
    std::string message;
};

struct SourceInfo {
    std::string name;               // as the user gave it
    std::string kind;               // "TUM folder", "synthetic scene", ...
    PinholeCamera camera;           // of the frames handed out (after rectification)
    bool camera_known = true;       // false: nobody says what camera it was, `camera` is a guess
    std::int64_t frame_count = -1;  // pairs, -1 if not known beforehand
    double fps = 30;
    // A device: its frames come at its own pace, and those that nobody takes in time are lost. Such
    // a source returns from Read at least every half second, with kWait if there is no frame.
    bool live = false;
    // What the source's own integer depth counts: exact steps of depth_m.
    double depth_units_per_m = 5000;
    bool rectified = false;  // lens distortion was corrected
    bool has_truth = false;
    // What a person should know: unpaired images, repeated stamps, ...
    std::vector<std::string> notes;
};

class FrameSource {
  public:
    virtual ~FrameSource() = default;
    virtual const SourceInfo& info() const = 0;
    // Fills `frame` (its storage is reused). Never throws.
    virtual ReadResult Read(Frame& frame) = 0;
    // Jumps so that the next Read returns frame `index` of the source's list. Sources that cannot
    // return false.
    virtual bool Seek(std::int64_t index) = 0;
    // Has the source itself record everything that it gives into this .oni file, until it ends or
    // is unplugged; before the first Read. With `lossless_colour` off colours are JPEG, a tenth of
    // the size; depth is always exact. Only OpenNI2 cameras can: others return an error that says
    // what to do (a FrameRecorder records any source).
    virtual Status RecordTo(const std::string& path, bool lossless_colour);
};

// Which part of a source to read.
struct FrameSelection {
    std::int64_t start = 0;   // first frame
    std::int64_t count = -1;  // how many frames to read, -1 = all
    std::int64_t stride = 1;  // take every stride-th
};

}  // namespace tessera
