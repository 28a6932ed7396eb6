#include "optimize/map_corrector.h"

#include <gtest/gtest.h>

#include <memory>
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

class StandInPager : public MapPager {
    Status Bring(const Eigen::Isometry3d&, BlockMap&, LabelMapper*) override {
        return Status::Ok();
    }
    Status Release(const Eigen::Isometry3d&, BlockMap&, LabelMapper*) override {
        return Status::Ok();
    }
    Status Complete(const BlockMap&) override { return Status::Ok(); }
};

// The map in use may be freed only if nothing can stop the new one: a pager's disk may be full.
TEST(MapCorrector, APagerMayStopAMapOfAllFrames) {
    for (const bool paged : {false, true}) {
        FieldSettings settings;
        ScanGraph graph(LoopConfig{}, settings.camera);
        ScanGraph::Memory memory;
        memory.keyframes.resize(1);
        memory.corrected = true;
        graph.Resume(std::move(memory));
        FrameStore store(1 << 20, 5000);
        MapCorrector::MakePager make_pager;
        if (paged)
            make_pager = [] { return std::unique_ptr<MapPager>(std::make_unique<StandInPager>()); };
        MapCorrector corrector(settings, graph, store, std::nullopt, make_pager);
        EXPECT_FALSE(corrector.FusesAll());
        ASSERT_TRUE(corrector.Begin(-1));
        EXPECT_EQ(corrector.FusesAll(), !paged);
    }
}

}  // namespace
}  // namespace tessera
