#include "finish/decimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Sphere;
using testing_support::Square;

std::vector<float> Exact(const TriangleMesh& mesh) {
    return std::vector<float>(mesh.vertices.size(), 0.0f);
}

class Decimation : public testing::Test {
  protected:
    void SetUp() override {
        if (!DecimationAvailable()) GTEST_SKIP() << kDecimationUnavailable;
    }
};

TEST_F(Decimation, APlaneNeedsFewTriangles) {
    TriangleMesh mesh = Square({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 1.0f, 20);
    EXPECT_LT(Decimate(mesh, Exact(mesh), 0.001, 0.01), 0.001);
    EXPECT_LE(mesh.triangles.size(), 10u);
    EXPECT_GE(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area +=
            0.5 *
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    EXPECT_NEAR(area, 1, 1e-5);
}

TEST_F(Decimation, ASphereStaysWithinTheError) {
    TriangleMesh mesh = Sphere(0.5f, 60);
    const std::size_t before = mesh.triangles.size();
    const double reached = Decimate(mesh, Exact(mesh), 0.002, 0.0);
    EXPECT_LT(mesh.triangles.size(), before / 5);
    EXPECT_LE(reached, 0.002);
    for (const auto& [a, b, c] : mesh.triangles) {
        const Eigen::Vector3f middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
        EXPECT_NEAR(middle.norm(), 0.5, 0.01);  // the quadrics' error is a mean, not a bound
        EXPECT_GT((mesh.vertices[b] - mesh.vertices[a])
                      .cross(mesh.vertices[c] - mesh.vertices[a])
                      .dot(middle),
                  -1e-7f);
    }
    TriangleMesh shared = Sphere(0.5f, 60);
    Decimate(shared, Exact(shared), 0.002, 0.5);
    EXPECT_NEAR(static_cast<double>(shared.triangles.size()), 0.5 * static_cast<double>(before), 4);
}

TEST_F(Decimation, ALowerLevelHasItsShareWhateverTheError) {
    TriangleMesh mesh = Sphere(0.5f, 60);
    const std::size_t before = mesh.triangles.size();
    const double first = DecimateTo(mesh, 0.25);
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 0.25 * static_cast<double>(before), 4);
    EXPECT_GT(first, 1e-5);
    const double second = DecimateTo(mesh, 0.25);
    EXPECT_GT(second, first);
    for (const auto& [a, b, c] : mesh.triangles)
        EXPECT_NEAR(((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3).norm(), 0.5,
                    10 * second);
    TriangleMesh empty;
    EXPECT_EQ(DecimateTo(empty, 0.25), 0);
}

// Half of a plane with ripples of 4 mm was measured to 1 mm, half to 16 mm.
TEST_F(Decimation, WhereDepthIsNoisyMoreIsGivenUp) {
    TriangleMesh mesh = Square({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 1.0f, 40);
    std::vector<float> sigmas_m;
    for (Eigen::Vector3f& v : mesh.vertices) {
        sigmas_m.push_back(v.x() < 0.5f ? 0.001f : 0.016f);
        v.z() += 0.004f * std::sin(60 * v.x()) * std::sin(60 * v.y());
    }
    Decimate(mesh, sigmas_m, 0.001, 0.0);
    int precise = 0, noisy = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const float x = (mesh.vertices[a].x() + mesh.vertices[b].x() + mesh.vertices[c].x()) / 3;
        ++(x < 0.5f ? precise : noisy);
    }
    EXPECT_GT(precise, 4 * noisy);
    // Where the halves meet, nothing is torn.
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area += 0.5 * std::abs((mesh.vertices[b] - mesh.vertices[a])
                                   .cross(mesh.vertices[c] - mesh.vertices[a])
                                   .z());
    EXPECT_NEAR(area, 1, 1e-4);
}

}  // namespace
}  // namespace tessera
