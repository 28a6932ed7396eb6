#include "finish/flaps.h"

#include <gtest/gtest.h>

#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Append;
using testing_support::Square;

constexpr PinholeCamera kCamera{160, 120, 150, 150, 79.5, 59.5};

// A camera a metre before the plane z = 0 that measures it, but for where a person stands half a
// metre from it, in columns below `person_px`, and where there is no depth, from `empty_px` on.
Frame PlaneFrame(int person_px, int empty_px) {
    Frame frame;
    frame.T_world_camera = Eigen::Isometry3d::Identity();
    frame.T_world_camera->translation() = Eigen::Vector3d(0, 0, -1);
    frame.depth_m = DepthImage(160, 120, 1.0f);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
            frame.depth_m(x, y) = x >= empty_px ? 0.0f : x < person_px ? 0.5f : 1.0f;
    return frame;
}

TEST(FrameEvidence, CountsWhatIsMeasuredAndWhatIsSeenThrough) {
    FrameEvidence evidence;
    for (int i = 0; i < 5; ++i) evidence.Add(kCamera, PlaneFrame(i == 0 ? 40 : 0, 120));
    evidence.Add(kCamera, Frame{});
    EXPECT_EQ(evidence.frames(), 5u);
    const auto at = [&](float x, float z) {
        const Evidence e = evidence.At({x, 0, z});
        return std::pair(e.confirmed, e.seen_through);
    };
    EXPECT_EQ(at(0, 0), std::pair(5, 0));
    EXPECT_EQ(at(0, 0.01f), std::pair(5, 0));
    EXPECT_EQ(at(0, 0.2f), std::pair(0, 0));       // hidden
    EXPECT_EQ(at(0, -0.2f), std::pair(0, 5));      // free
    EXPECT_EQ(at(-0.2f, -0.5f), std::pair(1, 4));  // the person, who went
    EXPECT_EQ(at(-0.4f, 0), std::pair(4, 0));      // the person hid it once
    EXPECT_EQ(at(0.3f, -0.2f), std::pair(0, 0));   // no depth there
    EXPECT_EQ(at(0.2f, -0.25f), std::pair(0, 0));  // nor beside it
    EXPECT_EQ(at(5, 0), std::pair(0, 0));          // outside of the image
    EXPECT_EQ(at(0, -2), std::pair(0, 0));         // behind the camera
}

TEST(FrameEvidence, KeepsABoundedNumberOfFrames) {
    FrameEvidence evidence;
    Frame frame = PlaneFrame(0, 160);
    frame.depth_m = DepthImage(8, 6, 1.0f);
    for (int i = 0; i < 400; ++i) evidence.Add({8, 6, 8, 8, 3.5, 2.5}, frame);
    EXPECT_EQ(static_cast<std::int64_t>(evidence.frames()), FrameEvidence::kMostFrames);
}

TEST(Flaps, WhatFramesLookThroughGoes) {
    FrameEvidence evidence;
    for (int i = 0; i < 5; ++i) evidence.Add(kCamera, PlaneFrame(i == 0 ? 40 : 0, 160));
    TriangleMesh mesh = Square({-0.3f, -0.3f, 0}, {1, 0, 0}, {0, 1, 0}, 0.6f, 12);
    RemoveFlaps(mesh, {});  // two corners hang on one edge each
    const TriangleMesh plane = mesh;
    Append(mesh, Square({-0.2f, -0.1f, -0.5f}, {1, 0, 0}, {0, 1, 0}, 0.15f, 5));  // the person
    const RemovedFlaps removed = RemoveFlaps(mesh, evidence);
    EXPECT_EQ(removed.triangles, 50u);
    EXPECT_EQ(removed.fringe, 0u);
    EXPECT_NEAR(removed.area_m2, 0.15 * 0.15, 1e-6);
    EXPECT_EQ(mesh.vertices, plane.vertices);
    EXPECT_EQ(mesh.triangles, plane.triangles);
}

TEST(Flaps, WhatMoreFramesMeasureStays) {
    FrameEvidence evidence;
    for (int i = 0; i < 5; ++i) evidence.Add(kCamera, PlaneFrame(i < 3 ? 40 : 0, 160));
    TriangleMesh board = Square({-0.2f, -0.1f, -0.5f}, {1, 0, 0}, {0, 1, 0}, 0.05f, 5);
    EXPECT_EQ(RemoveFlaps(board, evidence).triangles, 0u);
    EXPECT_EQ(board.triangles.size(), 48u);
}

TEST(Flaps, SpikesAndStripsGoTheSurfaceStays) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 10);
    RemoveFlaps(mesh, {});
    const std::size_t surface = mesh.triangles.size();
    EXPECT_EQ(surface, 198u);
    // A strip of ten triangles that grows out of the border at vertices 5 and 6.
    std::uint32_t a = mesh.triangles[0][0], b = 0;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (mesh.vertices[t[k]].y() == 0 && mesh.vertices[t[(k + 1) % 3]].y() == 0)
                a = t[k], b = t[(k + 1) % 3];
    ASSERT_NE(a, b);
    for (int i = 0; i < 10; ++i) {
        const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back({0.5f, -0.1f * static_cast<float>(i + 1), 0});
        mesh.normals.push_back({0, 0, -1});
        mesh.colours.push_back({});
        mesh.triangles.push_back({b, a, next});
        (i % 2 == 0 ? a : b) = next;
    }
    EXPECT_EQ(RemoveFlaps(mesh, {}).fringe, 10u);
    EXPECT_EQ(mesh.triangles.size(), surface);
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
}

}  // namespace
}  // namespace tessera
