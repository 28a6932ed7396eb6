// Decoding runs ahead of the pipeline on a thread of its own, over a bounded ring whose frames'
// storage goes round: in steady state nothing is allocated.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "io/frame_source.h"
#include "io/selected_frames.h"

namespace tessera {

// One thread calls Next; any thread may call RequestStop. The reader's own thread is the only one
// that reads the source.
class FrameReader {
  public:
    // Starts reading at once, at most `capacity` (>= 1) frames ahead; when that many wait, reading
    // waits.
    FrameReader(std::unique_ptr<FrameSource> source, const FrameSelection& selection,
                int capacity = 4);
    ~FrameReader();  // stops and joins, at any moment
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    const SourceInfo& info() const { return info_; }

    // Waits for the next selected frame, in the source's order, and swaps it into `frame`, whose
    // old storage is used for a later one. On kSkip and kWait (passed on from a live source, at
    // least every half second) `frame` stays as it was. kEnd and kError are final; after
    // RequestStop it is kEnd.
    ReadResult Next(Frame& frame);

    // What reading and decoding the frame took that Next gave last (also a skipped one),
    // milliseconds.
    double decode_ms() const { return decode_ms_; }

    // Next returns kEnd from now on, also where it waits; frames read ahead are dropped.
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
    std::atomic<std::uint64_t> written_{
        0};  // slots filled so far: the reader thread's; releases the slot
    std::atomic<std::uint64_t> taken_{0};  // slots emptied so far: Next's; releases the slot
    std::atomic<bool> stop_{false};
    std::atomic<std::uint32_t> events_{
        0};  // grows with each change of the three above: what waiting waits on
    double decode_ms_ = 0;
    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace tessera
