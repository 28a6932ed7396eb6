#include "viz/time_line.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/trajectory.h"
#include "report/run_record.h"

namespace tessera {
namespace {

// A break in the recording, or another clock, is no longer than this.
constexpr double kLongestBreak_s = 1;

// The paths of a run's clocks, oldest first (see WriteTrajectory). Empty without a trajectory.txt.
std::vector<std::vector<StampedPose>> ReadPaths(const std::string& folder) {
    constexpr int kMostClocks = 1000;
    const std::string newest = folder + "/trajectory.txt";
    std::vector<std::vector<StampedPose>> paths;
    std::error_code ignored;
    for (int clock = 1; clock < kMostClocks; ++clock) {
        const std::string path = NumberedPath(newest, clock);
        if (!std::filesystem::exists(path, ignored)) break;
        if (Result<Trajectory> earlier = ReadTrajectory(path); earlier.ok())
            paths.push_back(std::move(earlier.value().poses));
    }
    Result<Trajectory> path = ReadTrajectory(newest);
    if (!path.ok()) return {};
    paths.push_back(std::move(path.value().poses));
    return paths;
}

const StampedPose* PoseOfFrame(const std::vector<StampedPose>& path, double stamp_s) {
    constexpr double kSame_s = 2e-6;  // both files have six decimals
    const auto found = std::ranges::lower_bound(path, stamp_s - kSame_s, {}, &StampedPose::stamp_s);
    return found != path.end() && found->stamp_s <= stamp_s + kSame_s ? &*found : nullptr;
}

// Gives the frames their poses. The newest frame belongs to the newest clock; a scan that was
// continued has older ones, for which there are no frames.
void AddPoses(const std::vector<std::vector<StampedPose>>& paths,
              std::vector<TimeLineFrame>& frames) {
    std::size_t clock = paths.size() - 1;
    for (std::size_t i = frames.size(); i-- > 0;) {
        const double stamp_s = frames[i].row.stamp_s;
        if (i + 1 < frames.size() && StartsAgain(stamp_s, frames[i + 1].row.stamp_s) && clock > 0)
            --clock;
        if (const StampedPose* pose = PoseOfFrame(paths[clock], stamp_s))
            frames[i].T_world_camera = pose->T_world_camera;
    }
}

void AddTimes(std::vector<TimeLineFrame>& frames) {
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double step_s = frames[i].row.stamp_s - frames[i - 1].row.stamp_s;
        frames[i].at_s = frames[i - 1].at_s + std::clamp(step_s, 0.0, kLongestBreak_s);
    }
}

std::vector<TimeLineFrame> PosesAsFrames(const std::vector<std::vector<StampedPose>>& paths) {
    std::vector<TimeLineFrame> frames;
    for (const std::vector<StampedPose>& path : paths)
        for (const StampedPose& pose : path) {
            TimeLineFrame& frame = frames.emplace_back();
            frame.row.index = static_cast<std::int64_t>(frames.size()) - 1;
            frame.row.stamp_s = pose.stamp_s;
            frame.row.state = FrameState::kFused;
            frame.T_world_camera = pose.T_world_camera;
        }
    return frames;
}

}  // namespace

std::optional<TimeLine> ReadTimeLine(const std::string& folder) {
    const std::vector<std::vector<StampedPose>> paths = ReadPaths(folder);
    if (paths.empty()) return std::nullopt;
    TimeLine line;
    const Result<FramesTable> table = ReadFramesTable(folder + "/frames.csv");
    if (table.ok()) {
        for (const FrameRow& row : table.value().rows) line.frames.emplace_back().row = row;
        if (!line.frames.empty()) AddPoses(paths, line.frames);
    }
    line.has_figures = std::ranges::any_of(
        line.frames, [](const TimeLineFrame& frame) { return frame.T_world_camera.has_value(); });
    if (!line.has_figures) line.frames = PosesAsFrames(paths);
    if (line.frames.size() < 2) return std::nullopt;
    AddTimes(line.frames);
    if (Result<RunRecord> run = ReadRunRecord(folder + "/run.json"); run.ok())
        line.run = std::move(run.value());
    return line;
}

const Eigen::Isometry3d& Replay::T_world_camera() const {
    static const Eigen::Isometry3d kNowhere = Eigen::Isometry3d::Identity();
    for (std::size_t i = position_ + 1; i-- > 0;)
        if (line_.frames[i].T_world_camera) return *line_.frames[i].T_world_camera;
    for (const TimeLineFrame& frame : line_.frames)
        if (frame.T_world_camera) return *frame.T_world_camera;
    return kNowhere;
}

void Replay::GoTo(std::size_t position) {
    playing_ = false;
    position_ = std::min(position, last());
}

void Replay::Step(int frames) {
    const auto from = static_cast<std::int64_t>(position_);
    GoTo(static_cast<std::size_t>(std::max<std::int64_t>(from + frames, 0)));
}

void Replay::TogglePlaying() {
    if (!playing_ && position_ == last()) position_ = 0;
    playing_ = !playing_;
    at_s_ = frame().at_s;
}

bool Replay::Advance(double since_s) {
    if (!playing_) return false;
    at_s_ += since_s;
    const std::size_t before = position_;
    while (position_ < last() && line_.frames[position_ + 1].at_s <= at_s_) ++position_;
    if (position_ == last()) playing_ = false;
    return position_ != before || !playing_;
}

}  // namespace tessera
