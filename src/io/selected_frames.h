// Reads the part of a source that a person asked for (--start, --frames, --stride).
#pragma once

#include <memory>

#include "io/frame_source.h"

namespace tessera {

// Seeks where the source can, else reads and drops what lies between. Owner thread only.
class SelectedFrames {
  public:
    SelectedFrames(std::unique_ptr<FrameSource> source, const FrameSelection& selection);

    FrameSource& source() { return *source_; }
    const SourceInfo& info() const { return source_->info(); }
    // The next selected frame. A frame that the source skips counts as one of selection.count,
    // kWait is passed on and does not. kError, with what to do, if the selection is impossible or
    // begins behind the source's end. kEnd and kError are final.
    ReadResult Next(Frame& frame);

  private:
    ReadResult Advance(Frame& frame);

    std::unique_ptr<FrameSource> source_;
    FrameSelection selection_;
    std::int64_t given_ = 0;     // frames handed out, skipped ones included
    std::int64_t position_ = 0;  // of the source's next frame
    ReadResult final_{ReadStatus::kOk, {}};
};

}  // namespace tessera
