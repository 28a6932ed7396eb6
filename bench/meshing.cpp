// Measures the cost of keeping the mesh up to date while a sequence is tracked and fused. After
// each frame a mesher with a block budget meshes the changed blocks on one thread. Times are CPU
// milliseconds of that thread, which other load on the machine affects little. Usage: meshing
// SOURCE [FRAMES [BUDGET...]]; a budget of 0 means no limit. Lag: the number of frames that the
// budget would need for the blocks still waiting.
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "io/frame_reader.h"
#include "mapping/mesher.h"
#include "run/open_source.h"
#include "system/pipeline.h"

namespace tessera {
namespace {

struct BudgetRun {
    int budget_blocks;
    Mesher mesher{Mesher::Config{}};
    std::vector<double> update_ms{}, remaining{}, updated{};
};

double ThreadCpuMs() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double Quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto nth = values.begin() +
                     static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

void Print(const BudgetRun& run) {
    const bool none = run.budget_blocks == Mesher::kNoLimit;
    fmt::print("{:>8} {:>9.0f} {:>7.2f} {:>7.2f} {:>7.2f} {:>9.0f} {:>9.0f} {:>8.1f}\n",
               none ? "none" : fmt::format("{}", run.budget_blocks), Quantile(run.updated, 0.5),
               Quantile(run.update_ms, 0.5), Quantile(run.update_ms, 0.95),
               Quantile(run.update_ms, 1), Quantile(run.remaining, 0.5), Quantile(run.remaining, 1),
               Quantile(run.remaining, 0.5) / run.budget_blocks);
}

int Run(const std::string& source_path, std::int64_t frames, std::vector<BudgetRun>& runs) {
    const RunConfig config;
    Result<std::unique_ptr<FrameSource>> source = OpenSource(source_path, config);
    if (!source.ok()) {
        fmt::print(stderr, "{}\n", source.message());
        return 2;
    }
    FrameReader reader(std::move(source.value()), {.count = frames}, config.read_ahead);
    Pipeline pipeline(config.pipeline, reader.info().camera);
    tbb::task_arena one_thread(1);
    Frame frame;
    for (;;) {
        const ReadResult read = reader.Next(frame);
        if (read.status == ReadStatus::kEnd || read.status == ReadStatus::kError) break;
        if (read.status != ReadStatus::kOk || !pipeline.Process(frame).fused) continue;
        for (BudgetRun& run : runs) {
            const double before_ms = ThreadCpuMs();
            one_thread.execute([&] { run.mesher.Update(pipeline.map(), run.budget_blocks); });
            run.update_ms.push_back(ThreadCpuMs() - before_ms);
            run.remaining.push_back(run.mesher.remaining());
            run.updated.push_back(static_cast<double>(run.mesher.updated().size()));
        }
    }
    fmt::print("{} frames fused, {} blocks\n", runs[0].update_ms.size(), pipeline.map().size() - 1);
    fmt::print("{:>8} {:>9} {:>7} {:>7} {:>7} {:>9} {:>9} {:>8}\n", "budget", "updated", "median",
               "p95", "max ms", "waiting", "most", "lag");
    for (const BudgetRun& run : runs) Print(run);
    return 0;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: meshing SOURCE [FRAMES [BUDGET...]]\n");
        return 2;
    }
    std::vector<tessera::BudgetRun> runs;
    for (int i = 3; i < argc; ++i) {
        const int budget = std::atoi(argv[i]);
        runs.push_back({budget > 0 ? budget : tessera::Mesher::kNoLimit});
    }
    if (runs.empty()) runs.push_back({tessera::Mesher::kNoLimit});
    return tessera::Run(argv[1], argc > 2 ? std::atoll(argv[2]) : -1, runs);
}
