// Benchmarks the predicted view of a box room with a ball, fused at 1 cm, 640 x 480: rasterised and
// ray cast, for an unchanged map and after each fused frame.
#include "bench_room.h"
#include "mapping/ray_caster.h"
#include "render/mesh_rasteriser.h"
#include "repetitions.h"

namespace tessera::bench {
namespace {

constexpr int kViews = 12;
constexpr float kMinDepth_m = .2f, kMaxDepth_m = 6.f;

// Fuses the first views of the room again and again.
struct Fusion {
    std::unique_ptr<BlockMap> map = std::make_unique<BlockMap>(BlockMap::Config{});
    Integrator integrator{{}, FullCamera()};
    std::vector<PreparedFrame> frames;
    int next = 0;

    Fusion() {
        for (int i = 0; i < kViews; ++i)
            frames.push_back(Prepared(RoomWithBall().Render(FullCamera(), TruePose(i))));
        for (int i = 0; i < kViews; ++i) FuseNext();
    }
    Eigen::Isometry3d FuseNext() {
        Integrator::View view;
        view.T_world_camera = TruePose(next);
        integrator.Integrate(frames[static_cast<std::size_t>(next)], view, *map);
        next = (next + 1) % kViews;
        return view.T_world_camera;
    }
};

void Predict(benchmark::State& state, ViewPredictor& predictor, bool fusing) {
    Fusion fusion;
    PredictedView view;
    Eigen::Isometry3d T_world_camera = TruePose(0);
    predictor.Predict(*fusion.map, FullCamera(), T_world_camera, kMinDepth_m, kMaxDepth_m, view);
    MeshRasteriser::Timings sum;
    auto* rasteriser = dynamic_cast<MeshRasteriser*>(&predictor);
    if (rasteriser) rasteriser->TakeTimings();
    for (auto _ : state) {
        if (fusing) {
            state.PauseTiming();
            T_world_camera = fusion.FuseNext();
            state.ResumeTiming();
        }
        predictor.Predict(*fusion.map, FullCamera(), T_world_camera, kMinDepth_m, kMaxDepth_m,
                          view);
        if (!rasteriser) continue;
        const MeshRasteriser::Timings parts = rasteriser->TakeTimings();
        sum.mesh_ms += parts.mesh_ms;
        sum.upload_ms += parts.upload_ms;
        sum.draw_ms += parts.draw_ms;
        sum.read_back_ms += parts.read_back_ms;
    }
    if (!rasteriser) return;
    const auto mean = benchmark::Counter::kAvgIterations;
    state.counters["mesh_ms"] = {sum.mesh_ms, mean};
    state.counters["upload_ms"] = {sum.upload_ms, mean};
    state.counters["draw_ms"] = {sum.draw_ms, mean};
    state.counters["read_back_ms"] = {sum.read_back_ms, mean};
    state.counters["bytes"] = static_cast<double>(rasteriser->bytes());
    state.SetLabel(rasteriser->renderer());
}

void Rasterise(benchmark::State& state) {
    auto rasteriser = MeshRasteriser::Create({});
    if (!rasteriser.ok()) return state.SkipWithError(rasteriser.message().c_str());
    Predict(state, *rasteriser.value(), state.range(0) != 0);
}
BENCHMARK(Rasterise)
    ->ArgName("fusing")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Apply(TakeMinimum);

void RayCast(benchmark::State& state) {
    RayCaster caster;
    Predict(state, caster, state.range(0) != 0);
}
BENCHMARK(RayCast)
    ->ArgName("fusing")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Apply(TakeMinimum);

}  // namespace
}  // namespace tessera::bench

BENCHMARK_MAIN();
