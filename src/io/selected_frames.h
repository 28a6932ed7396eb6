// Reads the part of a source that the user selected (--start, --frames, --stride).
#pragma once

#include <memory>

#include "io/frame_source.h"

namespace tessera {

// Seeks if the source can; otherwise reads and drops the frames in between. Owner thread only.
class SelectedFrames {
  public:
    SelectedFrames(std::unique_ptr<FrameSource> source, const FrameSelection& selection);

    FrameSource& source() { return *source_; }
    const SourceInfo& info() const { return source_->info(); }
    // Returns the next selected frame. A frame that the source skips counts towards
    // selection.count; kWait is passed on and does not count. An invalid selection, or one that
    // starts past the source's end, returns kError with what to do. kEnd and kError are final.
    ReadResult Next(Frame& frame);

  private:
    ReadResult Advance(Frame& frame);

    std::unique_ptr<FrameSource> source_;
    FrameSelection selection_;
    std::int64_t given_ = 0;     // frames returned, including skipped ones
    std::int64_t position_ = 0;  // index of the source's next frame
    ReadResult final_{ReadStatus::kOk, {}};
};

}  // namespace tessera
