#include "export/image_set.h"

#include "export/posed_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(PosedFrames, AreThoseWithAPoseInOrder) {
    const TempFolder folder;
    WritePosedScan(folder / "a.scan");
    const auto frames = PosedFrames::Open(folder / "a.scan");
    ASSERT_TRUE(frames.ok()) << frames.message();
    EXPECT_EQ(frames.value()->camera(), SmallCamera());
    EXPECT_EQ(frames.value()->depth_units_per_m(), 5000);
    std::vector<std::string> names;
    ASSERT_TRUE(frames.value()
                    ->ForEach([&](const PosedFrame& frame) {
                        names.push_back(frame.name);
                        EXPECT_TRUE(frame.T_world_camera.isApprox(
                            PosedCamera(std::stoi(frame.name)), 1e-12))
                            << frame.name;
                        EXPECT_FALSE(frame.images->depth_png.empty());
                        return Status::Ok();
                    })
                    .ok());
    EXPECT_EQ(names, (std::vector<std::string>{"000000", "000001", "000003", "000004"}));
    const Status stopped = frames.value()->ForEach(
        [](const PosedFrame& frame) { return Status::Error("no " + frame.name); });
    EXPECT_EQ(stopped.message(), "no 000000");
}

TEST(PosedFrames, AScanWithoutThemNamesTheKey) {
    const TempFolder folder;
    WritePosedScan(folder / "a.scan", false);
    const auto frames = PosedFrames::Open(folder / "a.scan");
    ASSERT_FALSE(frames.ok());
    EXPECT_NE(frames.message().find("scan.frames=all"), std::string::npos) << frames.message();
    EXPECT_FALSE(PosedFrames::Open(folder / "none.scan").ok());
}

TEST(PosedFrames, NobodysPicturesAreWrittenOver) {
    const TempFolder folder;
    EXPECT_TRUE(MakeImageFolder(folder / "new/images").ok());
    EXPECT_TRUE(MakeImageFolder(folder / "new/images").ok());
    WriteBytes(folder / "new/images/000000.jpg", "mine");
    EXPECT_NE(
        MakeImageFolder(folder / "new/images").message().find("new/images: already contains files"),
        std::string::npos);
    EXPECT_FALSE(MakeImageFolder(folder / "new/images/000000.jpg").ok());
}

TEST(SamplePoints, AreSpreadOverTheList) {
    TriangleMesh mesh;
    for (int i = 0; i < 10; ++i) mesh.vertices.push_back({static_cast<float>(i), 0, 0});
    mesh.triangles = {{0, 1, 2}};
    const TriangleMesh some = SamplePoints(mesh, 4);
    ASSERT_EQ(some.vertices.size(), 4u);
    EXPECT_TRUE(some.triangles.empty());
    EXPECT_EQ(some.colours.at(3), (Rgb8{128, 128, 128}));
    const float expected[] = {0, 2, 5, 7};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(some.vertices[i].x(), expected[i]);
    EXPECT_EQ(SamplePoints(mesh, 100).vertices, mesh.vertices);
    EXPECT_TRUE(SamplePoints({}, 100).vertices.empty());
}

}  // namespace
}  // namespace tessera
