// Labelled runs whose predicted labels are rasterised, beside ray cast ones ([D18] 3.4).
#include <gtest/gtest.h>

#include <atomic>

#include "render/mesh_rasteriser.h"
#include "run/run.h"
#include "semantics/instance_view.h"
#include "support/temp_folder.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

class LabelPredictionTest : public testing::Test {
  protected:
    LabelPredictionTest() {
        config.synthetic.frames = 30;
        config.synthetic.fps = 3;  // covers the whole motion of the scene
        config.synthetic.camera = {160, 120, 131, 131, 79.5, 59.5};
        config.labels.synthetic_missed = config.labels.synthetic_wrong = 0;
    }
    void SetUp() override {
        if (const auto made = MeshRasteriser::Create({}); !made.ok())
            GTEST_SKIP() << made.message();
    }

    RunConfig config;
    TempFolder folder;
    const std::atomic<bool> stop{false};
};

// On the desk the voxels are about as large as the pixels, so there are few pixels without a
// neighbour of another object. Of the rest, over 99.5 % must agree.
TEST_F(LabelPredictionTest, AgreesOnTheDesk) {
    EngineInput input;
    auto source = OpenSynthetic("synthetic:desk", config.synthetic);
    ASSERT_TRUE(source.ok()) << source.message();
    input.source = std::move(source.value());
    auto labelling = OpenLabelling("synthetic", "synthetic:desk", config.synthetic, config.labels);
    ASSERT_TRUE(labelling.ok()) << labelling.message();
    input.labelling = std::move(labelling.value());
    input.config = config;
    input.stop = &stop;
    const PinholeCamera camera = input.source->info().camera;
    LockstepEngine engine(std::move(input));
    InstanceView cast(LabelPrediction::kRayCast), drawn(LabelPrediction::kRaster);
    Image<InstanceId> expected, shown;
    int views = 0, compared = 0, same = 0, labelled = 0;
    for (FrameOutcome outcome; engine.Next(outcome);) {
        if (outcome.kind != FrameOutcome::Kind::kFrame) continue;
        if (outcome.labels) drawn.Voted(outcome.labels->votes.blocks);
        if (++views % 5 != 0) continue;
        const BlockMap& map = engine.mapping().map();
        const Eigen::Isometry3d& T = outcome.report.track.T_world_camera;
        cast.Predict(map, camera, T, .1f, 5, expected);
        drawn.Predict(map, camera, T, .1f, 5, shown);
        for (int v = 1; v + 1 < camera.height; ++v)
            for (int u = 1; u + 1 < camera.width; ++u) {
                bool uniform = true;
                for (int i = 0; i < 9; ++i)
                    uniform = uniform && expected(u + i % 3 - 1, v + i / 3 - 1) == expected(u, v) &&
                              shown(u + i % 3 - 1, v + i / 3 - 1) == shown(u, v);
                compared += uniform;
                same += uniform && shown(u, v) == expected(u, v);
                labelled += uniform && expected(u, v) != 0;
            }
    }
    EXPECT_EQ(views, config.synthetic.frames);
    EXPECT_GT(labelled, 5000);
    EXPECT_GT(same, .995 * compared) << same << " of " << compared;
    RecordProperty("same", same);
    RecordProperty("compared", compared);
}

TEST_F(LabelPredictionTest, FindsTheSameObjects) {
    const auto objects = [&](LabelPrediction prediction) {
        config.labels.prediction = prediction;
        RunRequest request;
        request.source = "synthetic:desk";
        request.labels = "synthetic";
        request.output_folder = folder / "run";
        const auto run = ExecuteRun(request, config, {}, stop);
        EXPECT_TRUE(run.ok()) << run.message();
        return run.ok() ? run.value().labels->objects : std::vector<MapObject>();
    };
    const std::vector<MapObject> cast = objects(LabelPrediction::kRayCast),
                                 drawn = objects(LabelPrediction::kRaster);
    EXPECT_GE(cast.size(), 8u);
    ASSERT_EQ(cast.size(), drawn.size());
    for (const MapObject& object : cast) {
        const bool found = std::ranges::any_of(drawn, [&](const MapObject& other) {
            return other.class_id == object.class_id &&
                   (other.centroid - object.centroid).norm() < .02;
        });
        EXPECT_TRUE(found) << object.class_name << " " << object.id;
    }
}

}  // namespace
}  // namespace tessera
