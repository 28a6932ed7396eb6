#include "synth/mesh_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "io/image_io.h"
#include "support/temp_folder.h"
#include "synth/camera_path.h"
#include "synth/frame_renderer.h"
#include "synth/hash_random.h"
#include "synth/model_path.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

// A 2 m x 1 m textured quad in the plane z = 0: top left red, top right green, bottom left blue,
// bottom right white.
class TexturedQuad : public testing::Test {
  protected:
    void SetUp() override {
        ColourImage image(64, 32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                image(x, y) = y < 16 ? (x < 32 ? Rgb8{250, 0, 0} : Rgb8{0, 250, 0})
                                     : (x < 32 ? Rgb8{0, 0, 250} : Rgb8{250, 250, 250});
        const std::string folder = ProcessFolder();
        ASSERT_TRUE(WriteColourImage(folder + "/quad_picture.png", image).ok());
        std::ofstream(folder + "/quad.mtl")
            << "newmtl picture\nmap_Kd quad_picture.png\nnewmtl plain\nKd 1 0.5 0\n"
               "map_Kd nowhere.png\n";
        std::ofstream(folder + "/textured.obj")
            << "mtllib quad.mtl\no Picture_01\nusemtl picture\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 "
               "0\nvt 0 0\nvt 1 0\n"
               "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\no Box_002\nusemtl plain\nv 3 0 0\nv 4 0 0\nv 4 "
               "1 0.5\nf 5 6 7\n";
        auto model = ReadObj(folder + "/textured.obj");
        ASSERT_TRUE(model.ok()) << model.message();
        scene_ = std::make_unique<MeshScene>(std::move(model.value()));
    }
    RgbF At(double x, double y) const {
        const SurfaceHit hit = scene_->CastRay({x, y, 1.5}, {0, 0, -1});
        EXPECT_TRUE(hit.valid());
        EXPECT_NEAR(hit.t, 1.5 - (x > 3 ? 0.5 * y : 0.0), 1e-6);
        return scene_->Colour(hit, 0.01f);
    }
    std::unique_ptr<MeshScene> scene_;
};

TEST_F(TexturedQuad, ColoursLieWhereTheTexturePutsThem) {
    const RgbF top_left = At(0.5, 0.75), top_right = At(1.5, 0.75), low_left = At(0.5, 0.25),
               low_right = At(1.5, 0.25);
    EXPECT_GT(top_left.r, 150);
    EXPECT_LT(top_left.g, 5);
    EXPECT_GT(top_right.g, 150);
    EXPECT_LT(top_right.b, 5);
    EXPECT_GT(low_left.b, 150);
    EXPECT_LT(low_left.r, 5);
    EXPECT_NEAR(low_right.r, low_right.b, 1);
}

TEST_F(TexturedQuad, AMissingTextureGivesTheMaterialsColour) {
    ASSERT_EQ(scene_->missing_textures().size(), 1u);
    EXPECT_NE(scene_->missing_textures()[0].find("nowhere.png"), std::string::npos);
    const RgbF orange = At(3.7, 0.4);
    EXPECT_NEAR(orange.g / orange.r, 0.5, 0.01);
    EXPECT_EQ(orange.b, 0);
}

TEST_F(TexturedQuad, ObjectsAreInstancesAndTheirStemsClasses) {
    ASSERT_EQ(scene_->instances().size(), 3u);
    EXPECT_EQ(scene_->instances()[1].name, "Picture_01");
    EXPECT_EQ(scene_->class_names()[scene_->instances()[1].class_id], "picture");
    EXPECT_EQ(scene_->class_names()[scene_->instances()[2].class_id], "box");
    EXPECT_EQ(scene_->InstanceOf(scene_->CastRay({3.7, 0.4, 2}, {0, 0, -1})), 2);
}

TEST_F(TexturedQuad, AViewSeesWhatSingleRaysMeet) {
    const PinholeCamera camera{40, 30, 35, 35, 19.5, 14.5};
    const Eigen::Isometry3d T = LookAt({1.5, -0.8, 1.9}, {1.6, 0.5, 0});
    const auto view = scene_->View(camera, T, 0);
    std::vector<SurfaceHit> hits(40 * 30);
    view->Cast({0, 0, 40, 30}, 0, 0, hits);
    int seen = 0;
    for (int i = 0; i < 40 * 30; ++i) {
        const Vector3d d = T.linear() * camera.Unproject(i % 40, i / 40, 1);
        const SurfaceHit expected = scene_->CastRay(T.translation(), d);
        ASSERT_EQ(hits[i].part, expected.part);
        if (!hits[i].valid()) continue;
        ++seen;
        EXPECT_NEAR(hits[i].t, expected.t, 1e-5);
        if (expected.part < 2) {
            EXPECT_NEAR(hits[i].t, -T.translation().z() / d.z(), 1e-5);
        }
    }
    EXPECT_GT(seen, 200);
}

TEST_F(TexturedQuad, AHitsPatchHoldsTheHit) {
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Vector3d p(2 * UniformFromBits(MixBits(i)), UniformFromBits(MixBits(i + 1000)), 0);
        const SurfaceHit hit = scene_->CastRay(p + Vector3d::UnitZ(), -Vector3d::UnitZ());
        ASSERT_TRUE(hit.valid());
        std::vector<bool> keep(static_cast<std::size_t>(scene_->patch_count()));
        keep.at(static_cast<std::size_t>(scene_->PatchOf(hit))) = true;
        const TriangleMesh patch = scene_->PatchMesh(&keep);
        ASSERT_EQ(patch.triangles.size(), 1u);
        // If p is inside, the three sub-triangles at p add up to the area of the patch.
        const auto area = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
            return 0.5 * (b - a).cross(c - a).norm();
        };
        const Vector3d a = patch.vertices[0].cast<double>(), b = patch.vertices[1].cast<double>(),
                       c = patch.vertices[2].cast<double>();
        EXPECT_NEAR(area(a, b, p) + area(b, c, p) + area(c, a, p), area(a, b, c), 1e-6);
        EXPECT_LE((a - b).norm(), 0.1001);
    }
}

TEST_F(TexturedQuad, AllPatchesTogetherHaveTheModelsArea) {
    const TriangleMesh mesh = scene_->PatchMesh(nullptr);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.triangles.size()), scene_->patch_count());
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area +=
            0.5 *
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    EXPECT_NEAR(area, 2.0 + 0.5 * std::hypot(1.0, 0.5), 1e-4);
}

TEST_F(TexturedQuad, AModelsOwnMotionLooksAtIt) {
    const CameraPath path = MakeModelPath(*scene_, Vector3d::UnitZ());
    EXPECT_GT(path.duration_s, 1);
    EXPECT_TRUE(path.T_world_camera(0.5).matrix().allFinite());
}

}  // namespace
}  // namespace tessera
