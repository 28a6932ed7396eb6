// The frames of a scan's path on their way into its file: with loop closure their places relative
// to a keyframe are known some time after their fusion.
#pragma once

#include <deque>

#include "scan/scan_writer.h"
#include "system/loop_journal.h"
#include "system/tracking_stage.h"

namespace tessera {

// As the map has it.
PathRecord RecordOf(const Frame& frame, const TrackedFrame& tracked);

// Owner thread only: the map's.
class PathLog {
  public:
    // `loops`: tracked frames wait for their place.
    explicit PathLog(bool loops) : loops_(loops) {}

    // A frame in the map as it is now, after all before; its number counts them.
    void Add(std::int64_t number, const PathRecord& record, ScanCheckpoint& into);
    // What is placed, and loop closure's frames under the same numbers.
    void Place(LoopNews& news, ScanCheckpoint& into);
    // The map was corrected, and what waits with it.
    void Move(const Eigen::Isometry3d& T_new_old);
    // What waits, with its place in the map; it goes on waiting.
    void AddWaiting(ScanCheckpoint& into) const;
    // A new world.
    void Clear();

  private:
    struct Numbered {
        std::int64_t frame_index = 0, number = 0;
    };

    const bool loops_;
    std::deque<std::pair<std::int64_t, PathRecord>> waiting_;
    std::vector<Numbered> placed_;  // of this process, by frame index
};

}  // namespace tessera
