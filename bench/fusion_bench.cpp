// Benchmarks each stage of fusion on 640 x 480 views of a room with 1 cm voxels and 4 cm
// truncation: preparing the frame, allocating blocks, finding the visible blocks, and updating
// their voxels.
#include <tbb/global_control.h>

#include "bench_room.h"
#include "mapping/visible_blocks.h"
#include "repetitions.h"
#include "scalar_kernels.h"

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

// The first frame, for which all blocks are new.
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

// A frame that sees only known blocks: the walk along the rays without any allocation.
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

// The whole stage after allocation, including FindVisibleBlocks. Every voxel of a visible block
// counts, whether or not the frame changes it.
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

using FuseKernel = void (*)(const FusionArguments&, const std::int32_t*, std::int32_t);

// The arguments that Integrator derives from its default settings, for a frame of the room and a
// stationary camera.
FusionArguments ArgumentsFor(BlockMap& map) {
    const PreparedFrame& frame = RoomPrepared();
    const Integrator::Config config;
    FusionArguments a{};
    a.field = map.field(0);
    a.weight = map.weight(0);
    a.colour = map.colour(0);
    a.coords = map.view().coords;
    a.depth_m = frame.depth_m.data();
    a.packed_colour = frame.packed_colour.data();
    a.width = FullCamera().width;
    a.height = FullCamera().height;
    a.fx = static_cast<float>(FullCamera().fx);
    a.fy = static_cast<float>(FullCamera().fy);
    a.cx = static_cast<float>(FullCamera().cx);
    a.cy = static_cast<float>(FullCamera().cy);
    a.frame = 1;
    const Eigen::Isometry3d T_camera_world = TruePose(0).inverse();
    for (int i = 0; i < 9; ++i)
        a.to_camera.rotation[i] = static_cast<float>(T_camera_world.linear()(i / 3, i % 3));
    for (int i = 0; i < 3; ++i)
        a.to_camera.translation[i] = static_cast<float>(T_camera_world.translation()(i));
    a.voxel_size_m = map.view().voxel_size_m;
    a.band = map.view().band;
    a.distance_weight = config.distance_weight;
    a.colour_weighting = config.colour_weighting;
    a.max_weight = static_cast<float>(config.max_weight);
    a.max_colour_weight = static_cast<float>(config.max_colour_weight);
    a.gain = a.frame_weight = a.frame_colour_weight = 1;
    return a;
}

// Number of voxels that differ by more than rounding error after one update by two kernels.
// Rounding may select the neighbouring pixel.
std::int64_t DifferingVoxels(FuseKernel kernel, FuseKernel other,
                             const std::vector<BlockId>& blocks) {
    const std::unique_ptr<BlockMap> a = FusedMap(RoomWithBall(), kTruncation_m, 10),
                                    b = FusedMap(RoomWithBall(), kTruncation_m, 10);
    kernel(ArgumentsFor(*a), blocks.data(), static_cast<std::int32_t>(blocks.size()));
    other(ArgumentsFor(*b), blocks.data(), static_cast<std::int32_t>(blocks.size()));
    std::int64_t differing = 0;
    for (const BlockId id : blocks)
        for (int i = 0; i < kBlockVoxels; ++i) {
            const FieldWord x = a->field(id)[i], y = b->field(id)[i];
            differing += std::abs(FieldDistance(x) - FieldDistance(y)) > 1e-3f ||
                         std::abs(FieldIntensity(x) - FieldIntensity(y)) > 1e-2f ||
                         std::abs(a->weight(id)[i] - b->weight(id)[i]) > 1;
        }
    return differing;
}

// Only the kernel, on one thread, for given visible blocks.
void FuseVoxels(benchmark::State& state, FuseKernel kernel) {
    VisibleBlocks visible;
    const std::vector<BlockId>& blocks = visible.Find(
        RoomMap(), FullCamera(), TruePose(0), RoomPrepared().depth_m, RoomPrepared().farthest_m);
    const auto voxels = static_cast<double>(blocks.size() * kBlockVoxels);
    if (static_cast<double>(DifferingVoxels(kernel, baseline::FuseBlocks, blocks)) > 1e-3 * voxels)
        return state.SkipWithError("the voxels differ from the portable code's");
    FusionArguments a = ArgumentsFor(RoomMap());
    for (auto _ : state) {
        ++a.frame;
        kernel(a, blocks.data(), static_cast<std::int32_t>(blocks.size()));
    }
    state.counters["blocks"] = static_cast<double>(blocks.size());
    state.counters["per_voxel"] = PerItem(state, voxels);
}
void FuseVoxelsArguments(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond);
    TakeMinimum(b);
}
BENCHMARK_CAPTURE(FuseVoxels, scalar, FuseBlocksScalar)->Apply(FuseVoxelsArguments);
BENCHMARK_CAPTURE(FuseVoxels, baseline, baseline::FuseBlocks)->Apply(FuseVoxelsArguments);
#ifdef TESSERA_HAVE_AVX2
void FuseVoxelsAvx2(benchmark::State& state) {
    if (!CpuHasAvx2()) return state.SkipWithError("no AVX2");
    FuseVoxels(state, avx2::FuseBlocks);
}
BENCHMARK(FuseVoxelsAvx2)->Apply(FuseVoxelsArguments);
#endif

}  // namespace
}  // namespace tessera::bench

BENCHMARK_MAIN();
