#include "export/transforms_json.h"

#include <nlohmann/json.hpp>

#include "export/posed_scan.h"
#include "io/mesh_io.h"

namespace tessera {
namespace {

using namespace testing_support;

class Transforms : public testing::Test {
  protected:
    void Write() {
        WritePosedScan(scan);
        const auto status =
            WriteTransforms(scan, PointsOfTheRoom(5000), folder / "set/transforms.json");
        ASSERT_TRUE(status.ok()) << status.message();
        json = nlohmann::json::parse(ReadBytes(folder / "set/transforms.json"));
    }
    // Converts from our world (x right, y down, z ahead) to the file's world (x right, y ahead, z
    // up).
    static Eigen::Vector3d Turned(const Eigen::Vector3d& p) { return {p.x(), p.z(), -p.y()}; }
    // Projects a point of the file's world into an image. Returns the position in pixels from the
    // image corner, and the depth.
    Eigen::Vector3d Project(const nlohmann::json& frame, const Eigen::Vector3d& p) const {
        Eigen::Matrix4d T;
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                T(r, c) = frame["transform_matrix"][static_cast<std::size_t>(r)]
                               [static_cast<std::size_t>(c)];
        const Eigen::Vector4d q = T.inverse() * p.homogeneous();  // x right, y up, z back
        const double ahead = -q.z();
        return {Number("cx") + Number("fl_x") * q.x() / ahead,
                Number("cy") - Number("fl_y") * q.y() / ahead, ahead};
    }
    double Number(const char* key) const { return json.at(key).get<double>(); }

    TempFolder folder;
    std::string scan = folder / "a.scan";
    nlohmann::json json;
};

TEST_F(Transforms, EveryPixelIsWhereTheFileSaysInColourAndDepth) {
    ASSERT_NO_FATAL_FAILURE(Write());
    EXPECT_EQ(json["camera_model"], "OPENCV");
    EXPECT_EQ(json["w"], 160);
    EXPECT_EQ(json["h"], 120);
    for (const char* key : {"k1", "k2", "p1", "p2"}) EXPECT_EQ(Number(key), 0);
    const int numbers[] = {0, 1, 3, 4};
    ASSERT_EQ(json["frames"].size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const nlohmann::json& frame = json["frames"][i];
        const auto colour =
            ReadColourImage(folder / "set/" + frame["file_path"].get<std::string>());
        const auto depth =
            ReadDepthImage(folder / "set/" + frame["depth_file_path"].get<std::string>());
        ASSERT_TRUE(colour.ok() && depth.ok()) << colour.message() << depth.message();
        for (int v = 3; v < 120; v += 9)
            for (int u = 3; u < 160; u += 9) {
                const Eigen::Vector3d p = SeenAt(numbers[i], u, v);
                const Eigen::Vector3d seen = Project(frame, Turned(p));
                ASSERT_NEAR(seen.x(), u + 0.5, 1e-6);  // centre of the pixel
                ASSERT_NEAR(seen.y(), v + 0.5, 1e-6);
                // Tolerance for two roundings.
                ASSERT_NEAR(depth.value()(u, v) * Number("integer_depth_scale"), seen.z(), 0.00061);
                ExpectSimilar(colour.value()(u, v), ColourAt(p), u, v);
            }
    }
}

// The points and the poses belong to the corrected depth.
TEST_F(Transforms, DepthIsCorrectedAsTheMeshWas) {
    WritePosedScan(scan);
    ASSERT_TRUE(WriteTransforms(scan, PointsOfTheRoom(100), folder / "set/t.json", 0.05).ok());
    const auto depth = ReadDepthImage(folder / "set/depth/000001.png");
    ASSERT_TRUE(depth.ok()) << depth.message();
    const double z_m = PosedCamera(1).inverse().linear().row(2) *
                       (SeenAt(1, 80, 60) - PosedCamera(1).translation());
    EXPECT_NEAR(0.001 * depth.value()(80, 60), z_m / (1 + 0.05 * z_m), 0.00061);
}

TEST_F(Transforms, PointsLieInTheFilesWorldAndAppliedTransformLeadsBack) {
    ASSERT_NO_FATAL_FAILURE(Write());
    const auto points = ReadPly(folder / "set/" + json["ply_file_path"].get<std::string>());
    ASSERT_TRUE(points.ok()) << points.message();
    ASSERT_EQ(points.value().vertices.size(), 5000u);
    Eigen::Matrix<double, 3, 4> T_file_world;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c)
            T_file_world(r, c) =
                json["applied_transform"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    EXPECT_EQ(T_file_world.col(3).norm(), 0);
    for (std::size_t i = 0; i < 5000; ++i) {
        const Eigen::Vector3d p = points.value().vertices[i].cast<double>(),
                              world = T_file_world.leftCols<3>().transpose() * p;
        ASSERT_LT((p - Turned(world)).norm(), 1e-9);
        ASSERT_LT(std::abs(PosedRoom().SignedDistance(world)), 1e-5) << i;
    }
    EXPECT_EQ(points.value().colours, PointsOfTheRoom(5000).colours);
}

TEST_F(Transforms, WhatIsThereAlreadyIsRefused) {
    ASSERT_NO_FATAL_FAILURE(Write());
    const auto again = WriteTransforms(scan, {}, folder / "set/other.json");
    EXPECT_NE(again.message().find("set/images: already contains files"), std::string::npos)
        << again.message();
    EXPECT_FALSE(std::filesystem::exists(folder / "set/other.json"));
}

}  // namespace
}  // namespace tessera
