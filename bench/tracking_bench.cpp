// Benchmarks tracking on 640 x 480 views of a room with 1 cm voxels and 4 cm truncation: the sums
// of one Gauss-Newton step over every second pixel, a complete track, and the prealignment.
#include <tbb/global_control.h>

#include "bench_room.h"
#include "repetitions.h"
#include "scalar_kernels.h"
#include "tracking/image_aligner.h"
#include "tracking/sdf_tracker.h"

namespace tessera::bench {
namespace {

constexpr double kTruncation_m = 0.04;
constexpr int kStep_px = 2;

const BlockMap& RoomMap() {
    static const std::unique_ptr<BlockMap> map = FusedMap(RoomWithBall(), kTruncation_m, 10);
    return *map;
}

const PreparedFrame& RoomPrepared(int view) {
    static const PreparedFrame prepared[2] = {
        Prepared(RoomWithBall().Render(FullCamera(), TruePose(4))),
        Prepared(RoomWithBall().Render(FullCamera(), TruePose(5)))};
    return prepared[view];
}

// A pose 1 cm and 9 mrad from the true pose.
Eigen::Isometry3d StartBeside(const Eigen::Isometry3d& T_world_camera) {
    Vector6d twist;
    twist << 0.005, -0.006, 0.004, 0.006, -0.005, 0.006;
    return Se3Exp(twist) * T_world_camera;
}

SdfArguments ArgumentsFor(const FramePoints& points, const Eigen::Isometry3d& T_world_camera,
                          bool use_intensity) {
    const SdfTracker::Config config;
    SdfArguments a{};
    static_cast<BlockMapView&>(a) = RoomMap().view();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.rotation[3 * i + j] =
                static_cast<float>(T_world_camera.linear()(i, j)) / a.voxel_size_m;
        a.translation[i] = static_cast<float>(T_world_camera.translation()(i)) / a.voxel_size_m;
    }
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.use_intensity = use_intensity;
    a.normalise = config.normalise;
    a.gain = 1;
    a.distance_scale_m = static_cast<float>(config.distance_scale_m);
    a.intensity_scale = static_cast<float>(ResidualModel::Config().intensity_scale);
    return a;
}

using SumKernel = void (*)(const SdfArguments&, int, int, double*);

// On one thread. The map is far larger than the caches of the core, and the points follow the image
// rows.
void SumPoints(benchmark::State& state, SumKernel kernel, bool use_intensity) {
    FramePoints points;
    points.Build(MakePointArguments(RoomPrepared(0), FullCamera(), {}, kStep_px, {2.0}, true));
    const SdfArguments a = ArgumentsFor(points, StartBeside(TruePose(4)), use_intensity);
    PoseSums sums, expected;
    baseline::SumSdfPoints(a, 0, points.count(), expected.value);
    for (auto _ : state) {
        sums = {};
        kernel(a, 0, points.count(), sums.value);
    }
    for (const int sum :
         {SumLayout::kDistanceError, SumLayout::kIntensityError, SumLayout::kHessian})
        if (!(std::abs(sums[sum] - expected[sum]) <= 1e-3 * std::abs(expected[sum])))
            return state.SkipWithError("the sums differ from the portable code's");
    const auto valid = static_cast<double>(points.valid());
    state.counters["points"] = valid;
    state.counters["known"] = sums[SumLayout::kKnown] / valid;
    state.counters["per_point"] = PerItem(state, valid);
}
void SumArguments(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond);
    TakeMinimum(b);
}
BENCHMARK_CAPTURE(SumPoints, scalar_geometric, SumSdfPointsScalar, false)->Apply(SumArguments);
BENCHMARK_CAPTURE(SumPoints, scalar_photometric, SumSdfPointsScalar, true)->Apply(SumArguments);
BENCHMARK_CAPTURE(SumPoints, baseline_geometric, baseline::SumSdfPoints, false)
    ->Apply(SumArguments);
BENCHMARK_CAPTURE(SumPoints, baseline_photometric, baseline::SumSdfPoints, true)
    ->Apply(SumArguments);
#ifdef TESSERA_HAVE_AVX2
void SumPointsAvx2(benchmark::State& state, bool use_intensity) {
    if (!CpuHasAvx2()) return state.SkipWithError("no AVX2");
    SumPoints(state, avx2::SumSdfPoints, use_intensity);
}
BENCHMARK_CAPTURE(SumPointsAvx2, geometric, false)->Apply(SumArguments);
BENCHMARK_CAPTURE(SumPointsAvx2, photometric, true)->Apply(SumArguments);
#endif

// Starts 1 cm and 9 mrad away, as after an imperfect prediction.
void Track(benchmark::State& state, VectorPath path, double alpha) {
    if (path == VectorPath::kAvx2 && !CpuHasAvx2()) return state.SkipWithError("no AVX2");
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(state.range(0)));
    ResidualModel::Config config;
    config.alpha_mode = ResidualModel::AlphaMode::kFixed;
    config.alpha = alpha;
    ResidualModel model(config);
    CpuSdfSums sums(path);
    SdfTracker tracker({}, FullCamera(), TrackJudge({}), model, true, &sums);
    const Eigen::Isometry3d start = StartBeside(TruePose(4));
    const TrackInput input{.frame = RoomPrepared(0),
                           .map = RoomMap(),
                           .T_world_camera_starts = {start},
                           .T_world_camera_last = start,
                           .since_last_s = 1.0 / 30.0,
                           .motion = {}};
    TrackResult result;
    for (auto _ : state) {
        model.Reset();
        result = tracker.Track(input);
    }
    const Eigen::Isometry3d error = TruePose(4).inverse() * result.T_world_camera;
    state.counters["iterations"] = result.iterations;
    state.counters["error_mm"] = 1e3 * error.translation().norm();
}
void TrackArguments(benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
    TakeMinimum(b);
}
BENCHMARK_CAPTURE(Track, baseline, VectorPath::kBaseline, 0.1)->Apply(TrackArguments);
BENCHMARK_CAPTURE(Track, avx2, VectorPath::kAvx2, 0.1)->Apply(TrackArguments);
BENCHMARK_CAPTURE(Track, avx2_geometric, VectorPath::kAvx2, 0.0)->Apply(TrackArguments);

// Alternates between two views 0.13 s apart.
void Align(benchmark::State& state) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(state.range(0)));
    ImageAligner aligner({}, FullCamera());
    int view = 0;
    aligner.Align(RoomPrepared(view), Eigen::Isometry3d::Identity());
    for (auto _ : state) {
        view = 1 - view;
        benchmark::DoNotOptimize(aligner.Align(RoomPrepared(view), Eigen::Isometry3d::Identity()));
    }
}
BENCHMARK(Align)->Apply(TrackArguments);

}  // namespace
}  // namespace tessera::bench

BENCHMARK_MAIN();
