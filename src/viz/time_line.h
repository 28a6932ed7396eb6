// The frames of a finished run, in order, for scrubbing through it: what frames.csv says of each,
// with its pose from trajectory.txt. Plain values; owner thread only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/se3.h"
#include "core/status.h"
#include "report/frames_table.h"
#include "report/run_record.h"

namespace tessera {

struct TimeLineFrame {
    FrameRow row;  // only index, stamp and state where the run has no frames.csv
    std::optional<Eigen::Isometry3d> T_world_camera;  // empty: the camera was lost
    double at_s = 0;                                  // since the first frame, without long breaks
};

struct TimeLine {
    std::vector<TimeLineFrame> frames;  // never empty
    bool has_figures = false;           // there is a frames.csv
    RunRecord run;                      // run.json; all defaults where it is missing
};

// Of a run's folder. Without frames.csv, each pose is a frame. nullopt: the folder has no
// trajectory.txt with at least two poses. A damaged frames.csv or run.json counts as missing.
std::optional<TimeLine> ReadTimeLine(const std::string& folder);

// A place on the time line, and its replay at the recorded rate.
class Replay {
  public:
    explicit Replay(TimeLine line) : line_(std::move(line)) {}

    const TimeLine& line() const { return line_; }
    std::size_t position() const { return position_; }
    std::size_t last() const { return line_.frames.size() - 1; }
    const TimeLineFrame& frame() const { return line_.frames[position_]; }
    // Where the camera stands: at a lost frame, where it was before, or is next.
    const Eigen::Isometry3d& T_world_camera() const;

    // Both stop the replay and stay on the line.
    void GoTo(std::size_t position);
    void Step(int frames);
    bool playing() const { return playing_; }
    void TogglePlaying();  // at the end: from the beginning
    // Lets the time pass. True if another frame is reached, or the end.
    bool Advance(double since_s);

  private:
    TimeLine line_;
    std::size_t position_ = 0;
    bool playing_ = false;
    double at_s_ = 0;  // while playing
};

}  // namespace tessera
