// Reads some frames of a source that can seek.
#pragma once

#include <vector>

#include "io/frame_source.h"

namespace tessera {

// Owner thread only.
class ChosenFrames : public ListedSource {
  public:
    // The source must outlive this object, and nothing else may read it meanwhile. `indices`: in
    // the order in which they are read.
    ChosenFrames(FrameSource& source, std::vector<std::int64_t> indices)
        : source_(source), indices_(std::move(indices)) {
        info_ = source.info();
        info_.frame_count = static_cast<std::int64_t>(indices_.size());
    }

    ReadResult Read(Frame& frame) override {
        if (next_ == info_.frame_count || !source_.Seek(indices_[static_cast<std::size_t>(next_)]))
            return {ReadStatus::kEnd, {}};
        ReadResult result = source_.Read(frame);
        if (result.status != ReadStatus::kWait) ++next_;
        return result;
    }

  private:
    FrameSource& source_;
    std::vector<std::int64_t> indices_;
};

}  // namespace tessera
