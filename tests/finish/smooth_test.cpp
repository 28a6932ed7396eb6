#include "finish/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Sphere;
using testing_support::Square;

std::vector<int> Everywhere(const TriangleMesh& mesh, int rounds) {
    return std::vector<int>(mesh.vertices.size(), rounds);
}

void Roughen(TriangleMesh& mesh, float sigma_m) {
    std::mt19937 random(11);
    std::normal_distribution<float> noise(0, sigma_m);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        mesh.vertices[v] += noise(random) * mesh.normals[v];
}

double RmsFromSphere(const TriangleMesh& mesh, double radius_m) {
    double sum = 0;
    for (const Eigen::Vector3f& v : mesh.vertices)
        sum += std::pow(v.cast<double>().norm() - radius_m, 2);
    return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
}

TEST(Smooth, NoiseGoesAndTheSphereStays) {
    TriangleMesh mesh = Sphere(0.5f, 50);
    Roughen(mesh, 0.005f);
    const double before_m = RmsFromSphere(mesh, 0.5);
    Smooth(mesh, Everywhere(mesh, 10));
    EXPECT_LT(RmsFromSphere(mesh, 0.5), before_m / 2);
    double mean_m = 0, facing = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        mean_m += static_cast<double>(mesh.vertices[v].norm());
        facing += static_cast<double>(mesh.normals[v].dot(mesh.vertices[v].normalized()));
        EXPECT_NEAR(mesh.normals[v].norm(), 1, 1e-4f);
    }
    const auto count = static_cast<double>(mesh.vertices.size());
    EXPECT_NEAR(mean_m / count, 0.5, 0.0005);  // it does not shrink
    EXPECT_GT(facing / count, 0.99);
}

TEST(Smooth, AFlatSquareKeepsItsPlaneAndItsBorder) {
    const TriangleMesh flat = Square({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1.0f, 10);
    TriangleMesh mesh = flat;
    Smooth(mesh, Everywhere(mesh, 10));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        EXPECT_NEAR(mesh.vertices[v].z(), 1, 1e-6f);
        // Only next to the corners does the border move.
        EXPECT_LT((mesh.vertices[v] - flat.vertices[v]).norm(), 0.04f);
    }
    EXPECT_LT((mesh.vertices[5] - flat.vertices[5]).norm(), 0.002f);  // amid a side
}

TEST(Smooth, EachVertexHasItsOwnRounds) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 30);
    Roughen(mesh, 0.004f);
    const TriangleMesh rough = mesh;
    std::vector<int> rounds;
    for (const Eigen::Vector3f& v : mesh.vertices) rounds.push_back(v.x() < 0.5f ? 0 : 8);
    Smooth(mesh, rounds);
    double left = 0, right = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (rounds[v] == 0) {
            EXPECT_EQ(mesh.vertices[v], rough.vertices[v]);
        }
        (rounds[v] == 0 ? left : right) += std::pow(static_cast<double>(mesh.vertices[v].z()), 2);
    }
    EXPECT_LT(right, left / 3);
    TriangleMesh untouched = rough;
    Smooth(untouched, Everywhere(untouched, 0));
    EXPECT_EQ(untouched.vertices, rough.vertices);
    EXPECT_EQ(untouched.normals, rough.normals);
}

}  // namespace
}  // namespace tessera
