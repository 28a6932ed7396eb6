// Reads and decodes ahead of the pipeline on its own thread. Frame storage is recycled, so nothing
// is allocated in steady state.
#pragma once

#include <atomic>
#include <memory>

#include "core/worker.h"
#include "io/frame_source.h"
#include "io/selected_frames.h"

namespace tessera {

// One thread calls Next. Any thread may call RequestStop. Only the reader's own thread reads the
// source.
class FrameReader {
  public:
    // Starts reading at once, at most `capacity` (>= 1) frames ahead. The reader thread waits while
    // that many frames are ready.
    FrameReader(std::unique_ptr<FrameSource> source, const FrameSelection& selection,
                int capacity = 4);
    ~FrameReader();  // stops and joins, at any time
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    const SourceInfo& info() const { return info_; }

    // Waits for the next selected frame, in the source's order, and swaps it into `frame`; the old
    // storage of `frame` is reused for a later frame. On kSkip and kWait (a live source sends one
    // at least every half second) `frame` is unchanged. kEnd and kError are final. After
    // RequestStop, returns kEnd.
    ReadResult Next(Frame& frame);

    // Milliseconds to read and decode the frame that Next returned last (even if skipped).
    double decode_ms() const { return decode_ms_; }

    // Makes Next return kEnd from now on, even if it is waiting. Frames read ahead are dropped.
    // Thread-safe.
    void RequestStop();

  private:
    // A frame's storage: empty on its way to the worker, filled on its way back.
    struct Slot {
        Frame frame;
        ReadResult result;
        double decode_ms = 0;
    };

    void Fill(std::unique_ptr<Slot> slot);
    ReadResult ReadInto(Frame& frame);

    SelectedFrames frames_;  // the worker's
    const SourceInfo info_;
    bool ended_ = false;  // the worker's
    std::atomic<bool> stop_{false};
    Wake taker_;
    FifoQueue<std::unique_ptr<Slot>> filled_;
    std::unique_ptr<Slot> last_;  // the end or an error, once it was taken
    double decode_ms_ = 0;
    Worker<std::unique_ptr<Slot>> worker_;
};

}  // namespace tessera
