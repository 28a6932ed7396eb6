// The frames of a scan's path on their way into its file. With loop closure, a frame's pose
// relative to a keyframe is known only some time after its fusion.
#pragma once

#include <deque>

#include "scan/scan_writer.h"
#include "system/loop_journal.h"
#include "system/tracking_stage.h"

namespace tessera {

// The pose is in the map frame.
PathRecord RecordOf(const Frame& frame, const TrackedFrame& tracked);

// Owner thread only: the map's.
class PathLog {
  public:
    // `loops`: tracked frames wait until loop closure places them.
    explicit PathLog(bool loops) : loops_(loops) {}

    // Adds a frame of the current map. `number` counts frames from 0, in order.
    void Add(std::int64_t number, const PathRecord& record, ScanCheckpoint& into);
    // Writes the frames that loop closure has placed, and its stored frames under the same numbers.
    void Place(LoopChanges& news, ScanCheckpoint& into);
    // The map was corrected. Moves the waiting frames with it.
    void Move(const Eigen::Isometry3d& T_new_old);
    // Writes the waiting frames with their poses in the map. They keep waiting.
    void AddWaiting(ScanCheckpoint& into) const;
    // Starts a new world.
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
