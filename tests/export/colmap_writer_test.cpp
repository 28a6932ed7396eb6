#include "export/colmap_writer.h"

#include <sstream>

#include "export/posed_scan.h"

namespace tessera {
namespace {

using namespace testing_support;

// All lines that are not comments.
std::vector<std::string> Lines(const std::string& path) {
    std::vector<std::string> lines;
    std::stringstream text(ReadBytes(path));
    for (std::string line; std::getline(text, line);)
        if (line.empty() || line[0] != '#') lines.push_back(line);
    return lines;
}

// As in COLMAP's documentation: q rotates and t translates from the world to the camera frame.
Eigen::Vector3d ToCamera(double w, const Eigen::Vector3d& q, const Eigen::Vector3d& t,
                         const Eigen::Vector3d& p) {
    return p + 2 * w * q.cross(p) + 2 * q.cross(q.cross(p)) + t;
}

TEST(Colmap, EveryPixelIsWhereTheFilesSay) {
    const TempFolder folder;
    WritePosedScan(folder / "a.scan");
    const auto status = WriteColmap(folder / "a.scan", PointsOfTheRoom(3000), folder / "set");
    ASSERT_TRUE(status.ok()) << status.message();
    const std::vector<std::string> cameras = Lines(folder / "set/cameras.txt"),
                                   images = Lines(folder / "set/images.txt");
    ASSERT_EQ(cameras.size(), 1u);
    std::stringstream camera(cameras[0]);
    std::string model;
    double id, width, height, fx, fy, cx, cy;
    camera >> id >> model >> width >> height >> fx >> fy >> cx >> cy;
    EXPECT_TRUE(camera && id == 1 && model == "PINHOLE" && width == 160 && height == 120)
        << cameras[0];
    ASSERT_EQ(images.size(), 8u);
    const int numbers[] = {0, 1, 3, 4};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(images[2 * i + 1], "");
        std::stringstream line(images[2 * i]);
        double image_id, w, camera_id;
        Eigen::Vector3d q, t;
        std::string name;
        line >> image_id >> w >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z() >> camera_id >>
            name;
        ASSERT_TRUE(line && image_id == static_cast<double>(i + 1) && camera_id == 1)
            << images[2 * i];
        const auto colour = ReadColourImage(folder / "set/images/" + name);
        ASSERT_TRUE(colour.ok()) << colour.message();
        for (int v = 3; v < 120; v += 9)
            for (int u = 3; u < 160; u += 9) {
                const Eigen::Vector3d p = SeenAt(numbers[i], u, v), seen = ToCamera(w, q, t, p);
                ASSERT_GT(seen.z(), 0);
                ASSERT_NEAR(fx * seen.x() / seen.z() + cx, u + 0.5, 1e-4);
                ASSERT_NEAR(fy * seen.y() / seen.z() + cy, v + 0.5, 1e-4);
                ExpectSimilar(colour.value()(u, v), ColourAt(p), u, v);
            }
    }
}

TEST(Colmap, PointsAreTheMeshsInTheWorld) {
    const TempFolder folder;
    WritePosedScan(folder / "a.scan");
    const TriangleMesh mesh = PointsOfTheRoom(3000);
    ASSERT_TRUE(WriteColmap(folder / "a.scan", mesh, folder / "set").ok());
    const std::vector<std::string> points = Lines(folder / "set/points3D.txt");
    ASSERT_EQ(points.size(), 3000u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::stringstream line(points[i]);
        double id, r, g, b, error;
        Eigen::Vector3d p;
        line >> id >> p.x() >> p.y() >> p.z() >> r >> g >> b >> error;
        ASSERT_TRUE(line && id == static_cast<double>(i + 1) && error == 0) << points[i];
        ASSERT_LT((p - mesh.vertices[i].cast<double>()).norm(), 1e-6);
        ASSERT_TRUE(r == mesh.colours[i].r && g == mesh.colours[i].g && b == mesh.colours[i].b)
            << points[i];
    }
    EXPECT_NE(WriteColmap(folder / "a.scan", mesh, folder / "set")
                  .message()
                  .find("already contains files"),
              std::string::npos);
}

}  // namespace
}  // namespace tessera
