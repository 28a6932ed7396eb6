// Reads some frames of a source that can seek.
#pragma once

#include <vector>

#include "io/frame_source.h"

namespace tessera {

// Owner thread only.
class ChosenFrames : public FrameSource {
  public:
    // The source must outlive this object, and nothing else may read it meanwhile. `indices`: in
    // the order in which they are read.
    ChosenFrames(FrameSource& source, std::vector<std::int64_t> indices)
        : source_(source), info_(source.info()), indices_(std::move(indices)) {
        info_.frame_count = static_cast<std::int64_t>(indices_.size());
    }

    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == indices_.size() || !source_.Seek(indices_[next_]))
            return {ReadStatus::kEnd, {}};
        ReadResult result = source_.Read(frame);
        if (result.status != ReadStatus::kWait) ++next_;
        return result;
    }
    bool Seek(std::int64_t index) override {
        if (index < 0 || index > info_.frame_count) return false;
        next_ = static_cast<std::size_t>(index);
        return true;
    }

  private:
    FrameSource& source_;
    SourceInfo info_;
    std::vector<std::int64_t> indices_;
    std::size_t next_ = 0;
};

}  // namespace tessera
