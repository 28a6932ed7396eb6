// A source whose frame i has stamp i and 4 x 3 pixels of depth i + 1. Some frames are skipped, and
// some are preceded by a wait.
#pragma once

#include <atomic>
#include <functional>
#include <set>

#include "io/frame_source.h"

namespace tessera {

class CountingSource : public FrameSource {
  public:
    struct Options {
        std::int64_t count = 10;
        bool knows_count = true;
        bool seeks = true;
        std::set<std::int64_t> skipped = {};
        std::set<std::int64_t> waits = {};                   // one kWait before each of them
        std::function<void(std::int64_t)> before_read = {};  // may block or throw
        std::atomic<std::int64_t>* reads = nullptr;          // number of calls of Read
    };

    explicit CountingSource(Options options) : options_(std::move(options)) {
        info_.name = "counting";
        if (options_.knows_count) info_.frame_count = options_.count;
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (options_.reads) ++*options_.reads;
        if (options_.before_read) options_.before_read(next_);
        if (options_.waits.erase(next_) > 0)
            return {ReadStatus::kWait, "before " + std::to_string(next_)};
        if (next_ >= options_.count) return {ReadStatus::kEnd, {}};
        const std::int64_t index = next_++;
        if (options_.skipped.count(index))
            return {ReadStatus::kSkip, "frame " + std::to_string(index)};
        frame.index = index;
        frame.stamp_s = static_cast<double>(index);
        frame.depth_m.Resize(4, 3);
        for (std::size_t i = 0; i < frame.depth_m.size(); ++i)
            frame.depth_m.data()[i] = static_cast<float>(index + 1);
        return {};
    }
    bool Seek(std::int64_t index) override {
        if (options_.seeks) next_ = index;
        return options_.seeks;
    }

  private:
    Options options_;
    SourceInfo info_;
    std::int64_t next_ = 0;
};

}  // namespace tessera
