// What loop closure has learnt since the last query, as a message for the thread that writes the
// scan file, and what it continues with when that is read again.
#pragma once

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "optimize/loop_closer.h"
#include "scan/scan_content.h"

namespace tessera {

// Holds copies only.
struct LoopChanges {
    std::vector<PathPose> passages;  // new, in order
    // New frames, and frames whose detections arrived since.
    std::vector<StoredFrame> frames;
    std::vector<Keyframe> keyframes;                   // new, or with new overlaps; in order
    std::vector<std::pair<int, KeyframePoses>> poses;  // of keyframes that are new or have moved
    // If there is more of it: the edges are long. The frames tell of newer ordinals by themselves.
    std::optional<LoopProgress> progress;
};

// Takes keyframes and stored frames out of `scan`.
LoopCloser::Memory TakeLoopMemory(ScanContent& scan);

// Owner thread only: the closer's. Without Begin, the first Take reports all that the closer has,
// so that a scan which is saved in the middle of a run is whole at once.
class LoopJournal {
  public:
    // Marks all that the closer has now as already reported, except its progress.
    void Begin(const LoopCloser& closer);
    // Marks a frame whose detections arrived late.
    void Touch(std::int64_t frame_index) { touched_.push_back(frame_index); }
    // Afterwards at most `most_frames` new frames. The rest follow in later calls. With all frames
    // the progress is the newest.
    static constexpr std::size_t kAllFrames = std::numeric_limits<std::size_t>::max();
    LoopChanges Take(const LoopCloser& closer, std::size_t most_frames = 4);

  private:
    // What a LoopProgress is told by. Edges are only added.
    struct Progress {
        std::size_t edges = 0;
        int loops = 0;
        bool corrected = false;
        std::int64_t next_ordinal = 0;

        bool operator==(const Progress&) const = default;
    };
    std::optional<LoopProgress> TakeProgress(const LoopCloser& closer, bool with_ordinal);

    bool begun_ = false;
    std::optional<Progress> progress_;  // as last reported
    std::size_t passages_ = 0;
    std::int64_t next_ordinal_ = 0;
    std::vector<KeyframePoses> poses_;   // by keyframe id, as last reported
    std::vector<std::size_t> overlaps_;  // of each keyframe, as last reported
    std::vector<std::int64_t> touched_;  // frame indices
};

}  // namespace tessera
