// What loop closure has learnt since it was last asked, as a message: for a scan file that is
// written on another thread.
#pragma once

#include <utility>
#include <vector>

#include "optimize/loop_closer.h"
#include "scan/scan_records.h"

namespace tessera {

// Copies: nothing in it belongs to anyone else.
struct LoopNews {
    std::vector<LoopCloser::Passage> passages;  // new, in order
    // New ones, and those in which objects were found since.
    std::vector<StoredFrame> frames;
    std::vector<Keyframe> keyframes;                   // new, in order
    std::vector<std::pair<int, KeyframePoses>> poses;  // of keyframes that are new or have moved
    LoopProgress progress;
};

// Owner thread only: the closer's. The first news are of all that the closer knows.
class LoopJournal {
  public:
    // All that the closer knows now is known.
    void Begin(const LoopCloser& closer);
    // A frame of which something became known later.
    void Touch(std::int64_t frame_index) { touched_.push_back(frame_index); }
    // At most so many new frames; the others come with later news.
    LoopNews Take(const LoopCloser& closer, std::size_t most_frames = 4);

  private:
    std::size_t passages_ = 0;
    std::int64_t next_ordinal_ = 0;
    std::vector<KeyframePoses> poses_;   // by keyframe, as they were told
    std::vector<std::int64_t> touched_;  // by frame index
};

}  // namespace tessera
