// Reads the part of a source that the user selected (--start, --frames, --stride).
#pragma once

#include <limits>
#include <memory>

#include "io/frame_source.h"

namespace tessera {

// Tells late frames from a clock that was set back. A stamp earlier than the last one is refused;
// but if the next one goes on from there, the clock starts again. Owner thread only.
class StampOrder {
  public:
    bool Accepts(double stamp_s) {
        const bool accepted = stamp_s >= last_s_ || stamp_s >= refused_s_;
        if (accepted) last_s_ = stamp_s;
        refused_s_ = accepted ? kNever_s : stamp_s;
        return accepted;
    }
    double last_s() const { return last_s_; }

  private:
    static constexpr double kNever_s = std::numeric_limits<double>::infinity();

    double last_s_ = -kNever_s, refused_s_ = kNever_s;
};

// Seeks if the source can; otherwise reads and drops the frames in between. Owner thread only.
class SelectedFrames {
  public:
    SelectedFrames(std::unique_ptr<FrameSource> source, const FrameSelection& selection);

    FrameSource& source() { return *source_; }
    const SourceInfo& info() const { return source_->info(); }
    // Returns the next selected frame. One with a time stamp in the past is skipped. A frame that
    // is skipped counts towards
    // selection.count; kWait is passed on and does not count. An invalid selection, or one that
    // starts past the source's end, returns kError with what to do. kEnd and kError are final.
    ReadResult Next(Frame& frame);

  private:
    ReadResult Advance(Frame& frame);

    std::unique_ptr<FrameSource> source_;
    FrameSelection selection_;
    StampOrder order_;
    std::int64_t given_ = 0;     // frames returned, including skipped ones
    std::int64_t position_ = 0;  // index of the source's next frame
    ReadResult final_{ReadStatus::kOk, {}};
};

}  // namespace tessera
