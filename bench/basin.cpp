// Measures the convergence basin: the distance from which the tracker still finds the pose. Uses
// random starts around true poses in exact rooms, and prints a Markdown table. Usage: basin [starts
// per column, default 100]
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "bench_room.h"
#include "mapping/ray_caster.h"
#include "tracking/icp_tracker.h"
#include "tracking/image_aligner.h"
#include "tracking/sdf_tracker.h"

namespace tessera::bench {
namespace {

struct Offset {
    double move_m, turn_deg;
};
constexpr Offset kOffsets[] = {{0.02, 1}, {0.04, 2},  {0.06, 4}, {0.08, 6},
                               {0.12, 8}, {0.16, 12}, {0.20, 15}};
constexpr double kTruncation_m = 0.04;
constexpr int kMapViews = 10, kTrueViews = 4;
constexpr double kFound_m = 0.005, kFound_rad = 0.005;

// A tracking method, and whether the prealignment provides a second start.
struct Method {
    const char* name;
    bool prealign;
};
constexpr Method kMethods[] = {{"sdf", false},          {"sdf", true},    {"sdf-geometric", false},
                               {"sdf-geometric", true}, {"icp", false},   {"icp", true},
                               {"icp-rgb", false},      {"icp-rgb", true}};
constexpr std::size_t kMethodCount = std::size(kMethods);

struct Outcome {
    bool found = false;
    bool misjudged = false;  // reported as good but wrong
};
struct Tally {
    int found = 0, misjudged = 0;
};

// A direction uniformly distributed on the sphere.
Eigen::Vector3d Direction(std::uint64_t key) {
    const double z = 2.0 * UniformFromBits(MixBits(key)) - 1.0;
    const double angle = 2.0 * std::numbers::pi * UniformFromBits(MixBits(key + 1));
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

// T_true with its centre moved and its axes rotated by exactly the offset.
Eigen::Isometry3d Beside(const Eigen::Isometry3d& T_true, const Offset& offset, int start) {
    const double turn_rad = offset.turn_deg * std::numbers::pi / 180.0;
    Eigen::Isometry3d T = T_true;
    T.linear() = T.linear() * Eigen::AngleAxisd(turn_rad, Direction(StreamKey(1, start)));
    T.translation() += offset.move_m * Direction(StreamKey(2, start));
    return T;
}

template <class Room>
class Basin {
  public:
    explicit Basin(const Room& room) : room_(room), map_(FusedMap(room, kTruncation_m, kMapViews)) {
        for (int i = 0; i < kTrueViews; ++i)
            frames_.push_back(Prepared(room.Render(FullCamera(), TruePose(TrueView(i)))));
    }

    // Returns the tally of each method. All methods use the same starts.
    std::array<Tally, kMethodCount> Run(const Offset& offset, int starts) const {
        std::vector<std::array<Outcome, kMethodCount>> outcomes(static_cast<std::size_t>(starts));
        tbb::parallel_for(0, starts, [&](int start) {
            // A thread that waits within one start must not begin another.
            tbb::this_task_arena::isolate(
                [&] { outcomes[static_cast<std::size_t>(start)] = RunStart(offset, start); });
        });
        std::array<Tally, kMethodCount> tallies{};
        for (const auto& outcome : outcomes)
            for (std::size_t m = 0; m < kMethodCount; ++m) {
                tallies[m].found += outcome[m].found;
                tallies[m].misjudged += outcome[m].misjudged;
            }
        return tallies;
    }

  private:
    // Halfway between fused views, so that no frame is tracked at a pose used for fusion.
    static double TrueView(int i) { return 1.5 + 2 * i; }
    static Eigen::Isometry3d TruePose(double view) {
        const int before = static_cast<int>(view);
        const Eigen::Isometry3d T = bench::TruePose(before);
        return T * Se3Exp((view - before) * Se3Log(T.inverse() * bench::TruePose(before + 1)));
    }

    // The camera was at the start pose for the last frame and is now at the true pose.
    std::array<Outcome, kMethodCount> RunStart(const Offset& offset, int start) const {
        const int view = start % kTrueViews;
        const PreparedFrame& frame = frames_[static_cast<std::size_t>(view)];
        const Eigen::Isometry3d T_true = TruePose(TrueView(view));
        const Eigen::Isometry3d T_start = Beside(T_true, offset, start);
        ImageAligner aligner({}, FullCamera());
        const Eigen::Isometry3d standing = Eigen::Isometry3d::Identity();
        aligner.Align(Prepared(room_.Render(FullCamera(), T_start)), standing);
        const Eigen::Isometry3d T_aligned = T_start * aligner.Align(frame, standing);

        std::array<Outcome, kMethodCount> outcomes;
        for (std::size_t m = 0; m < kMethodCount; ++m) {
            TrackInput input{.frame = frame,
                             .map = *map_,
                             .T_world_camera_starts = {T_start},
                             .T_world_camera_last = T_start,
                             .since_last_s = 1.0 / 30.0,
                             .motion = {}};
            if (kMethods[m].prealign) input.T_world_camera_starts.push_back(T_aligned);
            const TrackResult result = TrackWith(kMethods[m].name, input);
            const Eigen::Vector3d move = result.T_world_camera.translation() - T_true.translation();
            outcomes[m].found =
                move.norm() < kFound_m && RotationAngle(T_true, result.T_world_camera) < kFound_rad;
            outcomes[m].misjudged = result.status == TrackStatus::kGood && !outcomes[m].found;
        }
        return outcomes;
    }

    static TrackResult TrackWith(const std::string& method, const TrackInput& input) {
        ResidualModel model({});
        const bool colour = method == "sdf" || method == "icp-rgb";
        const TrackJudge judge(JudgeConfig());
        if (method.starts_with("sdf"))
            return SdfTracker({}, FullCamera(), judge, model, colour).Track(input);
        return IcpTracker({}, FullCamera(), judge, model, colour, std::make_unique<RayCaster>())
            .Track(input);
    }

    // Large offsets must not be refused.
    static TrackJudge::Config JudgeConfig() {
        TrackJudge::Config config;
        config.max_jump_m = config.good_innovation_m = 1;
        config.max_jump_rad = config.good_innovation_rad = 1;
        return config;
    }

    Room room_;
    std::unique_ptr<BlockMap> map_;
    std::vector<PreparedFrame> frames_;
};

template <class Room>
void PrintRoom(const char* name, const Room& room, int starts) {
    const Basin<Room> basin(room);
    std::vector<std::array<Tally, kMethodCount>> columns;
    for (const Offset& offset : kOffsets) columns.push_back(basin.Run(offset, starts));
    for (std::size_t m = 0; m < kMethodCount; ++m) {
        fmt::print("| {} | {} | {} |", name, kMethods[m].name, kMethods[m].prealign ? "yes" : "no");
        int misjudged = 0;
        for (const auto& column : columns) {
            fmt::print(" {:.0f} |", 100.0 * column[m].found / starts);
            misjudged += column[m].misjudged;
        }
        fmt::print(" {:.1f} |\n",
                   100.0 * misjudged / (starts * static_cast<double>(columns.size())));
    }
    std::fflush(stdout);
}

void PrintHeader() {
    fmt::print("| room | method | prealign |");
    for (const Offset& o : kOffsets) fmt::print(" {:.0f} cm, {} deg |", 100 * o.move_m, o.turn_deg);
    fmt::print(" good but wrong |\n| --- | --- | --- |");
    for (std::size_t i = 0; i < std::size(kOffsets) + 1; ++i) fmt::print(" --- |");
    fmt::print("\n");
}

}  // namespace
}  // namespace tessera::bench

int main(int argc, char** argv) {
    const int starts = argc > 1 ? std::atoi(argv[1]) : 100;
    if (starts < 1) {
        fmt::print(stderr, "usage: basin [starts per column, at least 1]\n");
        return 2;
    }
    using namespace tessera::bench;
    PrintHeader();
    PrintRoom("box with ball", RoomWithBall(), starts);
    PrintRoom("textured wall", NoiseWall(), starts);
    tessera::testing_support::BoxRoom bare = RoomWithBall();
    bare.texture = 0;
    PrintRoom("box with ball, bare", bare, starts);
    return 0;
}
