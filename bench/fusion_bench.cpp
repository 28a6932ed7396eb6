// Fusion stage by stage on 640 x 480 views of a room at 1 cm voxels and 4 cm truncation: preparing
// the frame, allocating blocks, finding the visible ones, and updating their voxels.
#include <tbb/global_control.h>

#include "bench_room.h"
#include "mapping/visible_blocks.h"
#include "repetitions.h"

namespace tessera::bench {
namespace {

constexpr double kTruncation_m = 0.04;

const Frame& RoomFrame() {
    static const Frame frame = RoomWithBall().Render(FullCamera(), TruePose(0));
    return frame;
}

const PreparedFrame& RoomPrepared() {
    static const PreparedFrame prepared = Prepared(RoomFrame());
    return prepared;
}

Integrator::View RoomView() {
    Integrator::View view;
    view.T_world_camera = TruePose(0);
    return view;
}

BlockMap& RoomMap() {
    static const std::unique_ptr<BlockMap> map = FusedMap(RoomWithBall(), kTruncation_m, 10);
    return *map;
}

tbb::global_control Threads(std::int64_t count) {
    return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)};
}

void Prepare(benchmark::State& state) {
    const auto threads = Threads(state.range(0));
    const Frame& frame = RoomFrame();
    PreparedFrame prepared;
    for (auto _ : state) PrepareFrame(frame, {}, prepared);
    state.counters["per_pixel"] = PerItem(state, static_cast<double>(frame.depth_m.size()));
}
BENCHMARK(Prepare)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Apply(TakeMinimum);

// The first frame: everything that it sees is new.
void AllocateFirstFrame(benchmark::State& state) {
    const auto threads = Threads(state.range(0));
    const PreparedFrame& frame = RoomPrepared();
    std::int64_t blocks = 0;
    for (auto _ : state) {
        BlockMap map(RoomMap().config());
        Integrator integrator({}, FullCamera());
        const Integrator::Report report = integrator.Integrate(frame, RoomView(), map);
        state.SetIterationTime(1e-3 * report.allocate_ms);
        blocks = report.new_blocks;
    }
    state.counters["new_blocks"] = static_cast<double>(blocks);
}
BENCHMARK(AllocateFirstFrame)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Apply(TakeMinimum);

// A frame that sees only what is known: the walk along the rays without an allocation.
void AllocateNothing(benchmark::State& state) {
    const auto threads = Threads(state.range(0));
    Integrator integrator({}, FullCamera());
    for (auto _ : state) {
        const Integrator::Report report =
            integrator.Integrate(RoomPrepared(), RoomView(), RoomMap());
        state.SetIterationTime(1e-3 * report.allocate_ms);
    }
}
BENCHMARK(AllocateNothing)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Apply(TakeMinimum);

void FindVisibleBlocks(benchmark::State& state) {
    const auto threads = Threads(state.range(0));
    const PreparedFrame& frame = RoomPrepared();
    const BlockMap& map = RoomMap();
    VisibleBlocks visible;
    std::size_t blocks = 0;
    for (auto _ : state)
        blocks =
            visible.Find(map, FullCamera(), TruePose(0), frame.depth_m, frame.farthest_m).size();
    state.counters["visible"] = static_cast<double>(blocks);
    state.counters["in_map"] = static_cast<double>(map.size() - 1);
}
BENCHMARK(FindVisibleBlocks)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Apply(TakeMinimum);

// The whole stage after allocation, FindVisibleBlocks included. A voxel counts if its block is
// visible, whether the frame changes it or not.
void Fuse(benchmark::State& state, VectorPath path, bool moving) {
    if (path == VectorPath::kAvx2 && !CpuHasAvx2()) return state.SkipWithError("no AVX2");
    const auto threads = Threads(state.range(0));
    Integrator integrator({}, FullCamera(), path);
    Integrator::View view = RoomView();
    if (moving) {
        view.motion.twist_per_s << 0.3, -0.2, 0.1, 0.2, 0.1, -0.1;
        view.motion.colour_delay_s = 0.01;
        view.motion.colour_readout_s = 0.02;
    }
    std::int64_t blocks = 0;
    for (auto _ : state) {
        const Integrator::Report report = integrator.Integrate(RoomPrepared(), view, RoomMap());
        state.SetIterationTime(1e-3 * report.fuse_ms);
        blocks = report.fused_blocks;
    }
    state.counters["blocks"] = static_cast<double>(blocks);
    state.counters["per_voxel"] = PerItem(state, static_cast<double>(blocks * kBlockVoxels));
}
void FuseArguments(benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseManualTime();
    TakeMinimum(b);
}
BENCHMARK_CAPTURE(Fuse, baseline, VectorPath::kBaseline, false)->Apply(FuseArguments);
BENCHMARK_CAPTURE(Fuse, avx2, VectorPath::kAvx2, false)->Apply(FuseArguments);
BENCHMARK_CAPTURE(Fuse, baseline_moving, VectorPath::kBaseline, true)->Apply(FuseArguments);
BENCHMARK_CAPTURE(Fuse, avx2_moving, VectorPath::kAvx2, true)->Apply(FuseArguments);

}  // namespace
}  // namespace tessera::bench

BENCHMARK_MAIN();
