// What a run sends to its window after the end.
#include "run/run_window.h"

#include <atomic>
#include <map>
#include <thread>

#include "core/stopwatch.h"
#include "io/mesh_io.h"
#include "run/run_fixture.h"

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

}  // namespace
}  // namespace tessera
