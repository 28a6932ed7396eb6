// Frames that a program passes in one by one, as a source for an engine.
#pragma once

#include <atomic>
#include <memory>

#include "core/queue.h"
#include "io/frame_source.h"

namespace tessera::python {

// Connects the thread that passes frames in with the one that reads the source.
class FrameFeed {
  public:
    // One thread at a time. The previous frame must have been read.
    void Push(Frame frame);
    // No more frames: a waiting reader gets the end. Thread-safe.
    void Close();
    // Waits for a frame. Returns false if closed and empty. Reading thread only.
    bool Pop(Frame& frame);

  private:
    Wake wake_;
    FifoQueue<Frame> frames_{1, wake_};
    std::atomic<bool> closed_{false};
};

class FeedSource : public FrameSource {
  public:
    FeedSource(std::shared_ptr<FrameFeed> feed, SourceInfo info)
        : feed_(std::move(feed)), info_(std::move(info)) {}

    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override;
    bool Seek(std::int64_t) override { return false; }

  private:
    std::shared_ptr<FrameFeed> feed_;
    SourceInfo info_;
};

}  // namespace tessera::python
