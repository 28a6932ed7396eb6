// Reads and decodes ahead of the pipeline on its own thread, into a bounded ring of slots. Frame
// storage is recycled, so nothing is allocated in steady state.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

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
    struct Slot {
        Frame frame;
        ReadResult result;
        double decode_ms = 0;
    };

    void ReadAhead();
    ReadResult ReadInto(Slot& slot);
    Slot& slot(std::uint64_t number) { return slots_[number % slots_.size()]; }
    void Signal();
    template <class Condition>
    void WaitUntil(Condition condition);

    SelectedFrames frames_;  // reader thread only, once it runs
    const SourceInfo info_;
    std::vector<Slot> slots_;
    std::atomic<std::uint64_t> written_{0};  // slots filled so far; set by the reader thread
    std::atomic<std::uint64_t> taken_{0};    // slots emptied so far; set by Next
    std::atomic<bool> stop_{false};
    // Incremented with each change of the three above; waiters wait on it.
    std::atomic<std::uint32_t> events_{0};
    double decode_ms_ = 0;
    std::jthread thread_;  // last member: ends before anything it uses
};

}  // namespace tessera
