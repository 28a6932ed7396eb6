#include "render/mesh_picture.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/se3.h"
#include "render/random_mesh.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

constexpr Rgb8 kWhite{255, 255, 255}, kRed{255, 0, 0};

PinholeCamera SmallCamera() { return {40, 30, 20, 20, 20, 15}; }

RenderStyle OnWhite() {
    RenderStyle style;
    style.background_top = style.background_bottom = kWhite;
    return style;
}

// In the plane z = 2, facing the origin: x from -0.5 to 0.5 m and y from 0 to 1 m, so that its
// edges pass through the centres of columns 15 and 25 and rows 15 and 25.
TriangleMesh RedSquare() {
    TriangleMesh mesh;
    mesh.vertices = {{-0.5f, 0, 2}, {0.5f, 0, 2}, {0.5f, 1, 2}, {-0.5f, 1, 2}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    mesh.colours.assign(4, kRed);
    return mesh;
}

TEST(MeshPicture, ASquareCoversItsPixels) {
    const ColourImage image =
        RenderMesh(RedSquare(), SmallCamera(), Eigen::Isometry3d::Identity(), OnWhite());
    ASSERT_EQ(image.width(), 40);
    ASSERT_EQ(image.height(), 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            // The fraction of the pixel inside the square. An edge passes through the pixel centre.
            const auto share = [](int i) {
                return i == 15 || i == 25 ? 0.5 : (i > 15 && i < 25 ? 1.0 : 0.0);
            };
            const int other = static_cast<int>(std::lround(255 * (1 - share(x) * share(y))));
            EXPECT_EQ(image(x, y).r, 255);
            EXPECT_NEAR(image(x, y).g, other, 0) << x << " " << y;
            EXPECT_NEAR(image(x, y).b, other, 0);
        }
}

TEST(MeshPicture, TheCameraMovesTheOtherWay) {
    // At 2 m one pixel is 0.1 m. The camera moves right, so the square moves left.
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation().x() = 0.4;
    const ColourImage image = RenderMesh(RedSquare(), SmallCamera(), T_world_camera, OnWhite());
    EXPECT_EQ(image(12, 20), kRed);
    EXPECT_EQ(image(22, 20), kWhite);
    // By 0.4 pixels. The samples are a quarter pixel from the centre, so they all change sides.
    T_world_camera.translation().x() = 0.04;
    const ColourImage near = RenderMesh(RedSquare(), SmallCamera(), T_world_camera, OnWhite());
    EXPECT_EQ(near(14, 20), kWhite);
    EXPECT_EQ(near(15, 20), kRed);
    EXPECT_EQ(near(24, 20), kRed);
    EXPECT_EQ(near(25, 20), kWhite);
}

TEST(MeshPicture, BackFacesAreLookedThrough) {
    TriangleMesh mesh = RedSquare();
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    RenderStyle style = OnWhite();
    const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    EXPECT_EQ(RenderMesh(mesh, SmallCamera(), T, style)(20, 20), kWhite);
    style.cull_back_faces = false;
    EXPECT_EQ(RenderMesh(mesh, SmallCamera(), T, style)(20, 20), kRed);
}

TEST(MeshPicture, ShadingByAngleAndNormalColours) {
    TriangleMesh mesh = RedSquare();
    RenderStyle style = OnWhite();
    PinholeCamera straight = SmallCamera();
    straight.cy = 5;  // moves the square to the middle of the view, where it is seen almost head-on
    const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    style.shading = RenderStyle::Shading::kNormal;
    EXPECT_EQ(RenderMesh(mesh, straight, T, style)(20, 10), (Rgb8{128, 128, 0}));
    mesh.normals.assign(4, Eigen::Vector3f(0, 1, 0));  // the mesh's own normals take precedence
    EXPECT_EQ(RenderMesh(mesh, straight, T, style)(20, 10), (Rgb8{128, 255, 128}));
    mesh.normals.clear();
    style.shading = RenderStyle::Shading::kShaded;
    const int head_on = RenderMesh(mesh, straight, T, style)(20, 6).r;
    const int slanted = RenderMesh(mesh, straight, T, style)(20, 14).r;
    EXPECT_GT(head_on, 215);
    EXPECT_LT(slanted, head_on);
    mesh.colours.clear();  // without colours the mesh is shaded
    style.shading = RenderStyle::Shading::kColour;
    EXPECT_EQ(RenderMesh(mesh, straight, T, style)(20, 6).r, head_on);
}

TEST(MeshPicture, AnEmptyMeshIsBackground) {
    const ColourImage image =
        RenderMesh({}, SmallCamera(), Eigen::Isometry3d::Identity(), OnWhite());
    EXPECT_EQ(image, ColourImage(40, 30, kWhite));
}

TEST(MeshPicture, ThePathIsDrawnWhereItIs) {
    RenderStyle style = OnWhite();
    style.path_colour = {0, 0, 255};
    style.frustum_m = 1e-6;
    Eigen::Isometry3d left = Eigen::Isometry3d::Identity(), right = left, behind = left;
    left.translation() = Vector3d(-0.5, 0, 2);  // pixel (15, 15)
    right.translation() = Vector3d(0.5, 0, 2);  // pixel (25, 15)
    behind.translation() = Vector3d(0.5, 0, -2);
    style.path = {left, right, behind};
    const ColourImage image = RenderMesh({}, SmallCamera(), Eigen::Isometry3d::Identity(), style);
    for (int x = 16; x < 25; ++x) EXPECT_LT(image(x, 15).r, 40) << x;
    EXPECT_EQ(image(12, 15), kWhite);
    EXPECT_EQ(image(20, 12), kWhite);
    EXPECT_LT(image(35, 15).r, 40);  // leaves the image towards `behind`
}

TEST(MeshPicture, TheSameForAnyNumberOfThreads) {
    TriangleMesh mesh = RandomMesh(3, 3000, 3000);
    TestRandom random(4);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        mesh.colours.push_back({static_cast<std::uint8_t>(255 * random.Next()), 90, 200});
    const MeshView view = ChooseView(mesh, {}, 200, 150);
    ColourImage first;
    for (const std::size_t threads : {1, 2, 4}) {
        tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const ColourImage image = RenderMesh(mesh, view.camera, view.T_world_camera);
        if (first.empty()) first = image;
        EXPECT_EQ(image, first) << threads;
    }
}

// Largest distance of the points from the image centre, as a fraction of half the width and half
// the height.
Eigen::Array2d MaxOffCentre(const MeshView& view, const std::vector<Eigen::Vector3f>& points) {
    Eigen::Array2d most = Eigen::Array2d::Zero();
    for (const Eigen::Vector3f& p : points) {
        const Vector3d p_camera = view.T_world_camera.inverse() * Vector3d(p.cast<double>());
        EXPECT_GT(p_camera.z(), 0);
        const Eigen::Vector2d pixel = view.camera.Project(p_camera);
        most.x() = std::max(most.x(), std::abs(pixel.x() / view.camera.cx - 1));
        most.y() = std::max(most.y(), std::abs(pixel.y() / view.camera.cy - 1));
    }
    return most;
}

TEST(ChooseView, FillsThePictureAndLooksDownOnAFloor) {
    for (const double side_m : {0.2, 3.0, 50.0}) {
        const MeshView view = ChooseView(Square(side_m, 20, 1));
        const Eigen::Array2d most = MaxOffCentre(view, Square(side_m, 20, 1).vertices);
        EXPECT_LT(most.maxCoeff(), 1.05) << side_m;  // one outlier in a hundred may lie outside
        EXPECT_GT(most.maxCoeff(), 0.8) << side_m;
        EXPECT_GT(view.T_world_camera.translation().z(), 1);
        EXPECT_LT(view.T_world_camera.linear()(2, 2), -0.4);  // looks down
        EXPECT_LT(view.T_world_camera.linear()(2, 1), 0);     // is upright
        EXPECT_NEAR(view.T_world_camera.linear().determinant(), 1, 1e-9);
    }
}

TEST(ChooseView, LooksWhereTheCamerasLookedFromBehindAndAbove) {
    // A wall at z = 4. The cameras start at the origin and look along +z with y down.
    TriangleMesh wall = Square(4, 20, 4);
    std::vector<Eigen::Isometry3d> path(10, Eigen::Isometry3d::Identity());
    for (std::size_t i = 0; i < path.size(); ++i) path[i].translation().x() = 0.1 * double(i);
    const MeshView view = ChooseView(wall, path);
    EXPECT_GT(view.T_world_camera.linear()(2, 2), 0.8);   // forward
    EXPECT_LT(view.T_world_camera.translation().z(), 0);  // behind
    EXPECT_LT(view.T_world_camera.translation().y(), 0);  // above
    std::vector<Eigen::Vector3f> positions;
    for (const auto& pose : path) positions.push_back(pose.translation().cast<float>());
    EXPECT_LT(MaxOffCentre(view, positions).maxCoeff(), 1);  // the path is in the image
}

TEST(ChooseView, FarOutliersDoNotShrinkTheScene) {
    TriangleMesh mesh = Square(2, 30, 0);
    const double height = ChooseView(mesh).T_world_camera.translation().z();
    mesh.vertices.push_back({500, 0, 0});
    mesh.vertices.push_back({0, -500, 300});
    EXPECT_NEAR(ChooseView(mesh).T_world_camera.translation().z(), height, 0.1 * height);
}

TEST(ChooseView, OddScenesGiveFiniteViews) {
    TriangleMesh point;
    point.vertices = {{1, 2, 3}};
    std::vector<Eigen::Isometry3d> around;
    for (int i = 0; i < 36; ++i)
        around.push_back(Se3Exp((Vector6d() << 0, i * 0.1745, 0, 0, 0, 0).finished()));
    for (const TriangleMesh& mesh : {TriangleMesh{}, point, RandomMesh(1, 30, 30)})
        for (const auto& path : {std::vector<Eigen::Isometry3d>{}, around})
            EXPECT_TRUE(ChooseView(mesh, path).T_world_camera.matrix().allFinite());
}

}  // namespace
}  // namespace tessera
