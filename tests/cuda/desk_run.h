// A complete run over the desk frames, and a check that two runs are identical.
#pragma once

#include <algorithm>

#include "cuda/desk_frames.h"
#include "cuda/same_map.h"
#include "system/pipeline.h"

namespace tessera::testing_support {

// `device` must outlive this object. Null means the CPU.
struct DeskRun {
    DeskRun(const PipelineConfig& config, Backend* device)
        : pipeline(config, DeskCamera(), {}, device) {
        for (const DeskFrame& frame : DeskFrames())
            reports.push_back(pipeline.Process(frame.frame));
    }

    // Whether the host map holds any voxels before they are requested.
    bool HasVoxels() {
        const BlockMap& map = pipeline.mapping().blocks();
        const FieldWord* begin = map.field(0);
        return std::any_of(begin, begin + static_cast<std::size_t>(map.size()) * kBlockVoxels,
                           [](FieldWord word) { return word != kUnknownField; });
    }

    Pipeline pipeline;
    std::vector<FrameReport> reports;
};

// Bit-exact comparison of the tracking results and of the fused map.
inline void ExpectSameRun(DeskRun& run, DeskRun& expected) {
    for (std::size_t i = 0; i < DeskFrames().size(); ++i) {
        ExpectSameTrack(run.reports[i].track, expected.reports[i].track, i);
        EXPECT_EQ(run.reports[i].fused, expected.reports[i].fused) << i;
    }
    EXPECT_TRUE(expected.reports.back().fused);
    ExpectSameMap(run.pipeline.map(), expected.pipeline.map());
}

}  // namespace tessera::testing_support
