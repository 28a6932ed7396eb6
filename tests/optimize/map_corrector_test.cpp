#include "optimize/map_corrector.h"

#include <gtest/gtest.h>

#include <optional>
#include <tuple>
#include <utility>

namespace tessera {
namespace {

// The band 2 m from the camera: 4 cm, or 2 % of the depth squared.
TEST(MapCorrector, WantsAMapThatIsOffByMoreThanItsBand) {
    for (const auto& [per_m, off_m, wants] : {std::tuple{0.0, 0.039, false},
                                              {0.0, 0.041, true},
                                              {0.02, 0.041, false},
                                              {0.02, 0.079, false},
                                              {0.02, 0.081, true}}) {
        FieldSettings settings;
        settings.map = {.voxel_size_m = 0.01, .truncation_m = 0.04, .band_per_m = per_m};
        ScanGraph graph(LoopConfig{}, settings.camera);
        ScanGraph::Memory memory;
        memory.keyframes.resize(1);
        memory.keyframes[0].T_world_camera = Eigen::Translation3d(off_m, 0, 0);
        memory.corrected = true;
        graph.Resume(std::move(memory));
        FrameStore store(1 << 20, 5000);
        const MapCorrector corrector(settings, graph, store, std::nullopt, {});
        EXPECT_EQ(corrector.WantsMap(), wants) << per_m << ", " << off_m;
    }
}

}  // namespace
}  // namespace tessera
