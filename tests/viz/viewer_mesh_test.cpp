// Tests of what the window shows when the map is replaced.
#include <X11/keysym.h>

#include "viz/window_fixture.h"

namespace tessera {
namespace {

class ViewerMesh : public testing_support::WindowTest {};

// Where the map was replaced, what was there stays until all of the new mesh is here.
TEST_F(ViewerMesh, AReplacedMeshDoesNotVanishFirst) {
    const auto share = [&] {
        EXPECT_TRUE(Until([&] { return link_.meshes.empty(); }));
        Rounds(3);
        return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); });
    };
    Frames(3);
    const double before = share();
    ASSERT_GT(before, 0.2);
    MeshUpdate part;
    ASSERT_TRUE(system_->Step() && link_.meshes.TryPop(part));
    part.clear = true;
    part.whole = false;
    part.blocks.resize(part.blocks.size() / 4);
    link_.meshes.TryPush(std::move(part));
    EXPECT_NEAR(share(), before, 0.01);
    // Another one, before the first was whole.
    link_.meshes.TryPush({.voxel_size_m = 0.04, .clear = true, .whole = false, .blocks = {}});
    EXPECT_NEAR(share(), before, 0.01);
    link_.meshes.TryPush({.voxel_size_m = 0.04, .clear = false, .whole = true, .blocks = {}});
    EXPECT_LT(share(), 0.02);  // the path
}

// Part of a room looks like a smaller room. What is whole is shown, and can be measured when it is
// the final mesh.
TEST_F(ViewerMesh, AfterTheEndTheMeshBeforeStaysUntilTheFinalOneIsWhole) {
    const auto share = [&] {
        Rounds(3);
        return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); });
    };
    Frames(3);
    const double before = share();
    ASSERT_GT(before, 0.2);
    link_.meshes.TryPush({.voxel_size_m = 0.04, .clear = true, .whole = false, .blocks = {}});
    link_.ended = true;
    EXPECT_NEAR(share(), before, 0.01);
    MoveTo("view");
    Key(XK_l);
    EXPECT_FALSE(FindControl("tools"));
    EXPECT_FALSE(FindControl("measure"));
    link_.meshes.TryPush({.voxel_size_m = 0.04, .whole = true, .last = true, .blocks = {}});
    EXPECT_LT(share(), 0.02);  // the path
    Key(XK_l);
    EXPECT_TRUE(FindControl("tools"));
}

// Two parts of a scan lie a kilometre apart. What is shown whole is the one with the camera.
TEST_F(ViewerMesh, TheWholeIsThePartWithTheCamera) {
    Frames(3);
    Click("view_all");
    MoveTo("view", 0.05f);  // no tooltip over the view
    const auto share = [&] {
        EXPECT_TRUE(Until([&] { return link_.meshes.empty(); }));
        Rounds(3);
        return Share(viewer_->Picture(), [](const Rgb8& c) { return !IsBackground(c); });
    };
    const double before = share();
    ASSERT_GT(before, 0.1);
    MeshUpdate far;
    ASSERT_TRUE(system_->Step() && link_.meshes.TryPop(far));
    ASSERT_FALSE(far.blocks.empty());
    for (GeometryBlock& block : far.blocks) {
        block.id += 100000;
        block.coord.x += 3125;  // 1000 m
    }
    link_.meshes.TryPush(std::move(far));
    EXPECT_NEAR(share(), before, 0.02);
}

}  // namespace
}  // namespace tessera
