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

TEST(PosedFrames, DamagedOnesAreLeftOutAndCounted) {
    const TempFolder folder;
    const std::string scan = folder / "a.scan";
    WritePosedScan(scan);
    const auto damage = [&](const std::vector<std::int64_t>& numbers) {
        auto file = ScanFile::OpenToWrite(scan);
        ASSERT_TRUE(file.ok());
        file.value()->Begin();
        for (const std::int64_t i : numbers) {
            FrameRecord record;
            const Result<Bytes> was = file.value()->ReadOne(ScanTable::kFrames, i);
            ASSERT_TRUE(was.ok() && record.Decode(was.value()));
            EncodedImages images = *record.stored.images.Read().value();
            images.depth_png.assign(40, 7);
            record.stored.images = StoredImages(images);
            // The last one is not even a frame.
            const Bytes bytes = i == 4 ? Bytes(9, 1) : record.Encode().value();
            file.value()->Put(ScanTable::kFrames, i, bytes);
        }
        ASSERT_TRUE(file.value()->Commit(true).ok());
        file.value()->Close();
    };
    ASSERT_NO_FATAL_FAILURE(damage({1, 4}));
    {
        const auto frames = PosedFrames::Open(scan);
        ASSERT_TRUE(frames.ok()) << frames.message();
        std::string names;
        const Status read = frames.value()->ForEach([&](const PosedFrame& frame) {
            names += frame.name + " ";
            EXPECT_EQ(frame.depth_m.width(), SmallCamera().width);
            return Status::Ok();
        });
        ASSERT_TRUE(read.ok()) << read.message();
        EXPECT_EQ(names, "000000 000003 ");
        ASSERT_EQ(frames.value()->notes().size(), 1u);
        EXPECT_EQ(
            frames.value()->notes()[0].find("2 of 5 frames are left out (" + scan + ": frame 1"),
            0u)
            << frames.value()->notes()[0];
    }
    ASSERT_NO_FATAL_FAILURE(damage({0, 3}));
    const auto none = PosedFrames::Open(scan);
    ASSERT_TRUE(none.ok()) << none.message();
    const Status nothing = none.value()->ForEach([](const PosedFrame&) { return Status::Ok(); });
    EXPECT_NE(nothing.message().find("; no frame can be exported"), std::string::npos)
        << nothing.message();
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
