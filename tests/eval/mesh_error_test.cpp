#include "eval/mesh_error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "eval/test_trajectories.h"
#include "render/closest_point.h"
#include "render/random_mesh.h"

namespace tessera {
namespace {

// A sphere around the origin with rings x 2 rings cells.
TriangleMesh Sphere(double radius_m, std::uint32_t rings) {
    TriangleMesh mesh;
    const std::uint32_t sectors = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < sectors; ++j) {
            const double theta = std::numbers::pi * i / rings;
            const double phi = 2 * std::numbers::pi * j / sectors;
            mesh.vertices.push_back(Eigen::Vector3d(radius_m * std::sin(theta) * std::cos(phi),
                                                    radius_m * std::sin(theta) * std::sin(phi),
                                                    radius_m * std::cos(theta))
                                        .cast<float>());
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < sectors; ++j) {
            const std::uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
            mesh.triangles.push_back({a, a + sectors, b});
            mesh.triangles.push_back({b, a + sectors, b + sectors});
        }
    return mesh;
}

// Random triangles overlap everywhere, which makes each nearest-point query slow.
MeshErrorOptions FewSamples() {
    MeshErrorOptions options;
    options.completeness_samples = 500;
    return options;
}

TEST(MeshError, ParallelPlanes) {
    const auto result = MeasureMeshError(Square(1, 10, 0.0125), Square(2, 1, 0));
    ASSERT_TRUE(result.ok()) << result.message();
    const ErrorStatistics& accuracy = result.value().accuracy_m;
    EXPECT_NEAR(accuracy.mean, 0.0125, 1e-9);
    EXPECT_NEAR(accuracy.rmse, 0.0125, 1e-9);
    EXPECT_NEAR(accuracy.max, 0.0125, 1e-9);
    EXPECT_NEAR(accuracy.std, 0, 1e-9);
    EXPECT_EQ(result.value().distances_m.size(), 121u);
}

TEST(MeshError, BeyondTheReferencesEdgeTheDistanceIsToTheEdge) {
    TriangleMesh point;
    point.vertices = {{1.3f, 0, 0.4f}};
    const auto result = MeasureMeshError(point, Square(2, 4, 0));
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().accuracy_m.max, 0.5, 1e-6);
}

TEST(MeshError, SpheresOfDifferentRadius) {
    const auto result = MeasureMeshError(Sphere(1.02, 60), Sphere(1, 200));
    ASSERT_TRUE(result.ok());
    // The reference's flat triangles lie at most 1 - cos(pi/200), 0.12 mm, below the sphere.
    EXPECT_NEAR(result.value().accuracy_m.mean, 0.02, 1.3e-4);
    EXPECT_NEAR(result.value().accuracy_m.max, 0.02, 1.3e-4);
    EXPECT_EQ(result.value().completeness, 1.0);
}

TEST(MeshError, CompletenessIsTheCoveredShareOfTheArea) {
    // The mesh covers x in [-1, 1] of the reference's [-2, 2]. Points up to 5 cm beyond the mesh
    // also count.
    TriangleMesh half = Square(2, 8, 0.03);
    for (Eigen::Vector3f& vertex : half.vertices) vertex.y() *= 2;
    const TriangleMesh reference = Square(4, 3, 0);
    const auto result = MeasureMeshError(half, reference);
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().completeness, (2 + 2 * 0.04) / 4, 5e-4);  // 4 cm: 3 up, 4 across
    half.triangles.clear();  // the vertices alone are too sparse to cover the area
    EXPECT_LT(MeasureMeshError(half, reference).value().completeness, 0.1);
    EXPECT_GT(MeasureMeshError(half, reference).value().completeness, 0.01);
}

TEST(MeshError, TheAlignmentIsApplied) {
    const TriangleMesh reference = Square(2, 2, 0);
    const TriangleMesh mesh = TransformMesh(Square(1, 5, 0.01), SomeTransform().inverse());
    EXPECT_GT(MeasureMeshError(mesh, reference).value().accuracy_m.mean, 0.1);
    MeshErrorOptions options;
    options.T_reference_mesh = SomeTransform();
    EXPECT_NEAR(MeasureMeshError(mesh, reference, options).value().accuracy_m.max, 0.01, 2e-6);
}

TEST(MeshError, AgreesWithTryingEveryTriangle) {
    const TriangleMesh mesh = RandomMesh(5, 300, 200), reference = RandomMesh(6, 80, 100);
    const auto result = MeasureMeshError(mesh, reference, FewSamples());
    ASSERT_TRUE(result.ok());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
        double nearest = 1e9;
        for (const auto& [a, b, c] : reference.triangles) {
            const Eigen::Vector3d q = ClosestOnTriangle(p, reference.vertices[a].cast<double>(),
                                                        reference.vertices[b].cast<double>(),
                                                        reference.vertices[c].cast<double>());
            nearest = std::min(nearest, (p - q).norm());
        }
        EXPECT_EQ(result.value().distances_m[i], static_cast<float>(nearest));
    }
}

TEST(MeshError, TheSameForAnyNumberOfThreads) {
    const TriangleMesh mesh = RandomMesh(8, 3000, 2000), reference = RandomMesh(9, 300, 500);
    const std::string expected =
        MeshErrorJson(MeasureMeshError(mesh, reference, FewSamples()).value());
    for (const std::size_t threads : {1, 3}) {
        tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(MeshErrorJson(MeasureMeshError(mesh, reference, FewSamples()).value()), expected);
    }
}

TEST(MeshError, NothingToMeasureIsAnError) {
    const TriangleMesh square = Square(1, 1, 0);
    EXPECT_NE(MeasureMeshError({}, square).message().find("no vertices"), std::string::npos);
    EXPECT_NE(MeasureMeshError(square, {}).message().find("no triangles"), std::string::npos);
    TriangleMesh huge = square;
    for (Eigen::Vector3f& vertex : huge.vertices) vertex *= 1e30f;
    EXPECT_NE(MeasureMeshError(square, huge).message().find("too large"), std::string::npos);
}

TEST(SampleSurface, SpreadsEvenlyByArea) {
    // Two triangles with areas 1 and 3.
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 5}, {2, 0, 5}, {0, 3, 5}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto points = SampleSurface(mesh, 4000);
    ASSERT_EQ(points.size(), 4000u);
    int low = 0, near_x = 0;
    for (const Eigen::Vector3d& p : points) {
        const bool first = p.z() < 1;
        EXPECT_LE(p.x() / 2 + p.y() / (first ? 1 : 3), 1 + 1e-9);
        EXPECT_GE(p.minCoeff(), 0);
        low += first;
        near_x += p.x() < 1;  // three quarters of each triangle
    }
    EXPECT_EQ(low, 1000);
    EXPECT_NEAR(near_x, 3000, 20);
    EXPECT_TRUE(SampleSurface({}, 10).empty());
}

TEST(TransformMesh, TurnsNormalsWithoutMovingThem) {
    TriangleMesh mesh = Square(1, 1, 0);
    mesh.normals.assign(4, {0, 0, 1});
    const TriangleMesh moved = TransformMesh(mesh, SomeTransform());
    EXPECT_LT((moved.normals[0].cast<double>() - SomeTransform().linear().col(2)).norm(), 1e-6);
    EXPECT_LT((moved.vertices[3].cast<double>() -
               SomeTransform() * Eigen::Vector3d(mesh.vertices[3].cast<double>()))
                  .norm(),
              1e-6);
}

TEST(ErrorColour, BlueGreenRed) {
    EXPECT_EQ(ErrorColour(0, 0.01), (Rgb8{0, 0, 255}));
    EXPECT_EQ(ErrorColour(0.005, 0.01), (Rgb8{0, 255, 0}));
    EXPECT_EQ(ErrorColour(0.01, 0.01), (Rgb8{255, 0, 0}));
    EXPECT_EQ(ErrorColour(7, 0.01), (Rgb8{255, 0, 0}));
    EXPECT_EQ(ErrorColours({0, 0.01f}, 0.01).size(), 2u);
}

TEST(MeshError, JsonHasTheContractsKeys) {
    const auto json = nlohmann::json::parse(
        MeshErrorJson(MeasureMeshError(Square(1, 2, 0.01), Square(1, 1, 0)).value()));
    EXPECT_EQ(json.size(), 6u);
    for (const char* key : {"accuracy_mean_m", "accuracy_std_m", "accuracy_max_m",
                            "accuracy_rmse_m", "completeness_5cm"})
        EXPECT_TRUE(json.at(key).is_number_float()) << key;
    EXPECT_EQ(json.at("points"), 9);
}

}  // namespace
}  // namespace tessera
