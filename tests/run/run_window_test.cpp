// What a run sends to its window.
#include <atomic>
#include <map>
#include <thread>

#include "core/stopwatch.h"
#include "io/detections_text.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "run/run_fixture.h"
#include "synth/synthetic_source.h"

namespace tessera {
namespace {

TEST_F(Run, ItsWindowGetsTheFinalMeshAndEndsIt) {
    config.live.mesh_blocks = 1;
    config.meshing.min_component_triangles = 0;
    ViewerLink link;
    link.open = true;
    request.viewer = &link;
    std::map<BlockId, std::size_t> triangles;
    std::atomic<bool> ended{false};
    std::jthread window([&] {
        const Stopwatch watch;
        for (MeshUpdate update; !update.last && watch.ElapsedMs() < 60'000;) {
            if (!link.meshes.TryPop(update)) {
                std::this_thread::yield();
                continue;
            }
            if (update.clear) triangles.clear();
            for (const GeometryBlock& block : update.blocks)
                triangles[block.id] = block.geometry.indices.size() / 3;
            ended = update.last && link.ended;
        }
        link.open = false;
    });
    ASSERT_TRUE(Execute().ok());
    window.join();
    EXPECT_TRUE(ended);
    const auto mesh = ReadPly(Out("mesh.ply"));
    ASSERT_TRUE(mesh.ok()) << mesh.message();
    std::size_t all = 0;
    for (const auto& [id, count] : triangles) all += count;
    EXPECT_EQ(all, mesh.value().triangles.size());
}

// Also if the first frames are lost.
TEST_F(Run, ItsWindowGetsTheTruePathInTheMapsWorld) {
    const auto source = OpenSynthetic(request.source, config.synthetic);
    ASSERT_TRUE(source.ok()) << source.message();
    std::vector<StampedPose> truth;
    for (Frame frame; source.value()->Read(frame).status == ReadStatus::kOk;)
        truth.push_back({frame.stamp_s, *frame.T_world_camera});
    ASSERT_EQ(truth.size(), 6u);
    ASSERT_GT((truth[0].T_world_camera.inverse() * truth[2].T_world_camera).translation().norm(),
              1e-3);
    request.poses_file = folder / "poses.txt";
    ASSERT_TRUE(WriteTrajectory(request.poses_file, {truth.begin() + 2, truth.end()}).ok());
    ViewerLink link;
    request.viewer = &link;
    ASSERT_TRUE(Execute().ok());
    int tracked = 0;
    for (FrameUpdate update; link.frames.TryPop(update);) {
        EXPECT_EQ(update.T_world_camera_truth.has_value(), update.report.tracked());
        if (!update.report.tracked() || !update.T_world_camera_truth) continue;
        ++tracked;
        EXPECT_TRUE(update.T_world_camera_truth->isApprox(update.report.track.T_world_camera, 1e-5))
            << update.report.index;
    }
    EXPECT_EQ(tracked, 4);
}

TEST_F(Run, RecordsTheDetectorThatItsWindowChose) {
    std::ofstream(folder / "cups.txt") << "1000.0 cup 0.9 10 10 40 40\n";
    request.labels = folder / "cups.txt";
    config.labels.classes = "cup keyboard";
    ViewerLink link;
    ViewerSettings settings;
    settings.detector = "synthetic";
    settings.detector_choice = 1;
    link.settings.Push(std::move(settings));
    request.viewer = &link;
    ASSERT_TRUE(Execute().ok());
    EXPECT_EQ(Json("run.json")["labels"]["detector"], "synthetic");
    const auto rows = ReadDetectionRows(Out("detections.txt"));
    ASSERT_TRUE(rows.ok()) << rows.message();
    EXPECT_EQ(rows.value().classes, (std::set<std::string>{"cup", "keyboard"}));
}

}  // namespace
}  // namespace tessera
