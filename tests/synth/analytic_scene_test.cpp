#include "synth/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "synth/camera_path.h"
#include "synth/furniture.h"
#include "synth/hash_random.h"
#include "synth/paint.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

double Area(const TriangleMesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area +=
            0.5 *
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    return area;
}

// Uses the divergence theorem. Positive only if the triangles face outwards.
double Volume(const TriangleMesh& mesh) {
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        volume += mesh.vertices[a].cast<double>().dot(
                      mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) /
                  6;
    return volume;
}

std::unique_ptr<AnalyticScene> MixedScene() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    const Paint red = add.Flat({200, 40, 40});
    add.Box(StandAt(0, 0, -0.1), {0, 0, 0}, {6, 6, 0.1}, red);
    add.Box(StandAt(0.5, 0.3, 0, 30), {0, 0, 0}, {0.6, 0.4, 0.8}, red);
    scene->BeginInstance("ball 1", "ball");
    add.Sphere(StandAt(-0.7, 0.4, 0), {0, 0, 0}, 0.35, red);
    scene->BeginInstance("drum 1", "drum");
    add.Cylinder(StandAt(0.1, -0.8, 0, 10), {0, 0, 0}, 0.2, 0.5, red);
    scene->Finish({});
    return scene;
}

TEST(AnalyticScene, InstanceMeshesHaveTheBodiesAreaAndVolumeAndFaceOutwards) {
    const auto scene = MixedScene();
    constexpr double kPi = std::numbers::pi;
    const TriangleMesh ball = scene->InstanceMesh(1), drum = scene->InstanceMesh(2);
    EXPECT_NEAR(Area(ball), 4 * kPi * 0.35 * 0.35, 0.005 * 1.54);
    EXPECT_NEAR(Volume(ball), 4.0 / 3 * kPi * std::pow(0.35, 3), 0.01 * 0.18);
    EXPECT_NEAR(Area(drum), 2 * kPi * 0.2 * (0.5 + 0.2), 0.005 * 0.88);
    EXPECT_NEAR(Volume(drum), kPi * 0.04 * 0.5, 0.01 * 0.063);
    EXPECT_EQ(scene->class_names()[scene->instances()[2].class_id], "drum");
}

TEST(AnalyticScene, TheReferenceMeshLiesOnTheSurface) {
    const auto scene = MixedScene();
    const TriangleMesh ball = scene->InstanceMesh(1);
    const Vector3d centre(-0.7, 0.4, 0.35);
    for (const auto& triangle : ball.triangles) {
        Vector3d middle = Vector3d::Zero();
        for (const auto v : triangle) {
            EXPECT_NEAR((ball.vertices[v].cast<double>() - centre).norm(), 0.35, 1e-6);
            middle += ball.vertices[v].cast<double>() / 3;
        }
        EXPECT_GT((middle - centre).norm(), 0.35 - 0.001);  // chords deviate by under 1 mm
        EXPECT_NEAR(*scene->SignedDistance(middle), 0, 0.001);
    }
}

TEST(AnalyticScene, AViewSeesWhatSingleRaysMeet) {
    const auto scene = MixedScene();
    PinholeCamera camera{80, 60, 70, 72, 39.5, 29.5};
    const Eigen::Isometry3d T_world_camera = LookAt({1.6, -2.0, 1.3}, {0, 0, 0.3});
    const auto view = scene->View(camera, T_world_camera, 0);
    std::vector<SurfaceHit> hits(80 * 60);
    int bodies[5] = {};
    for (int y = 0; y < 60; y += 20) {
        view->Cast({0, y, 80, y + 20}, 0.25, -0.25, std::span(hits).subspan(y * 80, 20 * 80));
    }
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 80; ++x) {
            const Vector3d d = camera.Unproject(x + 0.25, y - 0.25, 1);
            const SurfaceHit expected =
                scene->CastRay(T_world_camera.translation(), T_world_camera.linear() * d);
            const SurfaceHit& hit = hits[y * 80 + x];
            ASSERT_EQ(hit.part, expected.part) << x << " " << y;
            if (!hit.valid()) continue;
            ++bodies[hit.part];
            EXPECT_NEAR(hit.t, expected.t, 1e-9);
            EXPECT_EQ(hit.chart, expected.chart);
            EXPECT_NEAR(hit.u, expected.u, 1e-5);
            EXPECT_NEAR(hit.cos_incidence, expected.cos_incidence, 1e-5);
        }
    }
    for (int part = 0; part < 4; ++part) EXPECT_GT(bodies[part], 20) << part;
}

TEST(AnalyticScene, AHitsPatchHoldsTheHit) {
    int hits = 0;
    const auto scene = MixedScene();
    for (std::uint64_t i = 0; i < 300; ++i) {
        const double a = 2 * std::numbers::pi * UniformFromBits(MixBits(i));
        const Vector3d eye(2 * std::cos(a), 2 * std::sin(a),
                           0.3 + 1.5 * UniformFromBits(MixBits(i + 999)));
        const Vector3d target(UniformFromBits(MixBits(i + 77)) - 0.7,
                              UniformFromBits(MixBits(i + 55)) - 0.5, 0.2);
        const SurfaceHit hit = scene->CastRay(eye, target - eye);
        if (!hit.valid()) continue;
        ++hits;
        std::vector<bool> keep(static_cast<std::size_t>(scene->patch_count()));
        keep[static_cast<std::size_t>(scene->PatchOf(hit))] = true;
        const TriangleMesh patch = scene->PatchMesh(&keep);
        ASSERT_GE(patch.triangles.size(), 1u);
        ASSERT_LE(patch.triangles.size(), 2u);
        const Vector3d p = eye + hit.t * (target - eye);
        Eigen::AlignedBox3d box;
        for (const auto& v : patch.vertices) box.extend(v.cast<double>());
        EXPECT_LT(box.exteriorDistance(p), 0.002);  // curved patches bulge
        for (const auto& t : patch.triangles)
            EXPECT_LT((patch.vertices[t[0]] - patch.vertices[t[2]]).norm(), 0.1415f);
    }
    EXPECT_GT(hits, 200);
}

TEST(AnalyticScene, DistanceIsTheNearestBodys) {
    const auto scene = MixedScene();
    EXPECT_NEAR(*scene->SignedDistance({-0.7, 0.4, 1.0}), 0.3, 1e-12);
    EXPECT_NEAR(*scene->SignedDistance({-2, -2, 0.25}), 0.25, 1e-12);
    EXPECT_NEAR(*scene->SignedDistance({0.1, -0.8, 0.25}), -0.2, 1e-12);
}

TEST(AnalyticScene, LightFallsAndShadowsAreDarker) {
    AnalyticScene scene;
    Furnisher add(scene);
    const Paint grey = add.Flat({128, 128, 128});
    add.Box(StandAt(0, 0, -0.1), {0, 0, 0}, {4, 4, 0.1}, grey);
    add.Box(StandAt(0, 0, 0.5), {0, 0, 0}, {1, 1, 0.05}, grey);
    Lighting lighting;
    lighting.lights = {{{0, 0, 3}, 0.05, 4.0}};
    scene.Finish(lighting);
    const auto brightness = [&](double x, double y) {
        return scene.Colour(scene.CastRay({x, y, 0.2}, {0, 0, -1}), 0.01f).g;
    };
    EXPECT_LT(brightness(0, 0), 0.5f * brightness(1.5, 0));
    EXPECT_GT(brightness(1.2, 0), brightness(1.9, 0));
    EXPECT_NEAR(brightness(1.5, 0), brightness(-1.5, 0), 8);
}

}  // namespace
}  // namespace tessera
