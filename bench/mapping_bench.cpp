// Benchmarks meshing and ray casting on a synthetic room with 1 cm voxels: a wavy floor, a sphere,
// a box. Reports times per block and per pixel, on one thread and on all threads.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "mapping/analytic_fields.h"
#include "mapping/mesher.h"
#include "mapping/ray_caster.h"
#include "mapping/scalar_ray_walker.h"
#include "repetitions.h"

namespace tessera {
namespace {

using namespace testing_support;

double Room(const Eigen::Vector3d& p) {
    static const Sdf kBox = Box({.5, .3, .1}, {.2, .3, .15}), kSphere = Sphere({-.5, -.2, 0}, .3);
    const double floor = .3 + .03 * std::sin(9 * p.x()) * std::cos(7 * p.y()) - p.z();
    return std::min({floor, kBox(p), kSphere(p)});
}

BlockMap& RoomMap() {
    static BlockMap map{BlockMap::Config{}};
    if (map.size() == 1)
        Fill(map, Room, {-20, -16, -5}, {19, 15, 5}, [](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(.5 + .2 * std::sin(20 * p.x()), .5, .5 + .3 * p.z());
        });
    return map;
}

// Meshes all blocks of the room again, as after a frame that changed each of them.
void MeshBlocks(benchmark::State& state) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(state.range(0)));
    BlockMap& map = RoomMap();
    Mesher mesher{Mesher::Config{}};
    std::uint32_t revision = 1;
    for (auto _ : state) {
        ++revision;
        for (BlockId id = 1; id < map.size(); ++id) map.MarkChanged(id, revision);
        mesher.Update(map);
    }
    const double blocks = map.size() - 1;
    state.counters["blocks"] = blocks;
    state.counters["per_block"] =
        benchmark::Counter(blocks * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["mesh_bytes_per_block"] = static_cast<double>(mesher.bytes()) / blocks;
}
BENCHMARK(MeshBlocks)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// The cost of finding the changed blocks if there are none.
void MeshNothing(benchmark::State& state) {
    Mesher mesher{Mesher::Config{}};
    mesher.Update(RoomMap());
    for (auto _ : state) benchmark::DoNotOptimize(mesher.Update(RoomMap()));
}
BENCHMARK(MeshNothing)->Unit(benchmark::kMicrosecond);

void AssembleMesh(benchmark::State& state) {
    Mesher mesher{Mesher::Config{}};
    mesher.Update(RoomMap());
    std::size_t triangles = 0;
    for (auto _ : state) triangles = mesher.Assemble().triangles.size();
    state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(AssembleMesh)->Unit(benchmark::kMillisecond)->UseRealTime();

Eigen::Isometry3d CastPose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(.4, Eigen::Vector3d::UnitX()).toRotationMatrix();
    T.translation() = Eigen::Vector3d(0, .5, -1.2);
    return T;
}

void CastView(benchmark::State& state, VectorPath path) {
    if (path == VectorPath::kAvx2 && !CpuHasAvx2()) return state.SkipWithError("no AVX2");
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(state.range(0)));
    const PinholeCamera camera;
    RayCaster caster(path);
    PredictedView view;
    for (auto _ : state) caster.Predict(RoomMap(), camera, CastPose(), .2f, 5.f, view);
    double hits = 0;
    for (std::size_t i = 0; i < view.depth_m.size(); ++i) hits += view.depth_m.data()[i] > 0;
    state.counters["hits"] = hits / static_cast<double>(view.depth_m.size());
    state.counters["per_pixel"] = bench::PerItem(state, static_cast<double>(view.depth_m.size()));
}
void CastArguments(benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
    bench::TakeMinimum(b);
}
BENCHMARK_CAPTURE(CastView, baseline, VectorPath::kBaseline)->Apply(CastArguments);
BENCHMARK_CAPTURE(CastView, avx2, VectorPath::kAvx2)->Apply(CastArguments);

// The same view by the scalar ray walk of the tests, one ray at a time. It computes no colours.
void CastViewScalar(benchmark::State& state) {
    const PinholeCamera camera;
    ScalarRayWalker walker(RoomMap(), camera, CastPose(), .2f, 5.f);
    for (auto _ : state)
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) benchmark::DoNotOptimize(walker.Cast(u, v));
    state.counters["per_pixel"] =
        bench::PerItem(state, static_cast<double>(camera.width * camera.height));
}
BENCHMARK(CastViewScalar)->Unit(benchmark::kMillisecond)->Apply(bench::TakeMinimum);

}  // namespace
}  // namespace tessera

BENCHMARK_MAIN();
