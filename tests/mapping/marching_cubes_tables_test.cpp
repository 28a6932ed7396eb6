#include "mapping/marching_cubes_tables.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tessera {
namespace {

using Segment = std::pair<int, int>;

std::set<Segment> Segments(int configuration, int face) {
    const FaceSegments s = CubeFaceSegments(configuration, face);
    std::set<Segment> result;
    for (int i = 0; i < s.count; ++i) result.insert({s.segment[i][0], s.segment[i][1]});
    return result;
}

bool CornerOnFace(int corner, int face) { return (corner >> face / 2 & 1) == face % 2; }

bool EdgeOnFace(int edge, int face) {
    const CubeEdge e = CubeEdgeAt(edge);
    return e.axis != face / 2 && CornerOnFace(e.corner, face);
}

// The corresponding edge on the opposite face of the cell.
int AcrossCell(int edge, int face_axis) {
    const CubeEdge e = CubeEdgeAt(edge);
    for (int other = 0; other < kCubeEdges; ++other) {
        const CubeEdge o = CubeEdgeAt(other);
        if (o.axis == e.axis && o.corner == (e.corner ^ 1 << face_axis)) return other;
    }
    return -1;
}

TEST(MarchingCubesTables, EdgesAreTheTwelvePairsOfAdjacentCorners) {
    std::set<std::pair<int, int>> pairs;
    for (int edge = 0; edge < kCubeEdges; ++edge) {
        const CubeEdge e = CubeEdgeAt(edge);
        EXPECT_EQ(e.corner >> e.axis & 1, 0);
        pairs.insert({e.corner, e.corner | 1 << e.axis});
    }
    EXPECT_EQ(pairs.size(), 12u);
}

// Any two configurations whose cells share the corners of a face draw the same segments on it, in
// opposite directions.
TEST(MarchingCubesTables, NeighboursAgreeOnEveryFace) {
    int compared = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int a = 0; a < kCubeConfigurations; ++a)
            for (int b = 0; b < kCubeConfigurations; ++b) {
                bool same_corners = true;
                for (int c = 0; c < 8; ++c)
                    if (CornerOnFace(c, 2 * axis))
                        same_corners &= (b >> c & 1) == (a >> (c | 1 << axis) & 1);
                if (!same_corners) continue;
                ++compared;
                std::set<Segment> mirrored;
                for (const auto& [from, to] : Segments(b, 2 * axis))
                    mirrored.insert({AcrossCell(to, axis), AcrossCell(from, axis)});
                EXPECT_EQ(Segments(a, 2 * axis + 1), mirrored) << a << " " << b << " " << axis;
            }
    EXPECT_EQ(compared, 3 * 256 * 16);
}

// Within a cell, a side of a triangle is either a segment on a face and used once, or interior and
// used once in each direction.
TEST(MarchingCubesTables, TrianglesFillTheSegmentsOfEveryConfiguration) {
    for (int configuration = 0; configuration < kCubeConfigurations; ++configuration) {
        std::map<Segment, int> sides;
        const CubeCase& cell = CubeCases()[configuration];
        for (int t = 0; t < cell.triangle_count; ++t)
            for (int i = 0; i < 3; ++i)
                ++sides[{cell.triangles[t][i], cell.triangles[t][(i + 1) % 3]}];
        std::set<Segment> segments;
        for (int face = 0; face < 6; ++face) segments.merge(Segments(configuration, face));
        for (const Segment& s : segments) EXPECT_EQ(sides[s], 1) << configuration;
        for (const auto& [side, count] : sides) {
            EXPECT_EQ(count, 1) << configuration;
            if (segments.count(side)) continue;
            EXPECT_EQ(sides.count({side.second, side.first}), 1u) << configuration;
            for (int face = 0; face < 6; ++face)
                EXPECT_FALSE(EdgeOnFace(side.first, face) && EdgeOnFace(side.second, face))
                    << configuration << ": a diagonal lies on face " << face;
        }
    }
}

TEST(MarchingCubesTables, VerticesLieOnCrossedEdgesOnly) {
    for (int configuration = 0; configuration < kCubeConfigurations; ++configuration) {
        std::set<int> used, crossed;
        const CubeCase& cell = CubeCases()[configuration];
        for (int t = 0; t < cell.triangle_count; ++t)
            used.insert(cell.triangles[t].begin(), cell.triangles[t].end());
        for (int edge = 0; edge < kCubeEdges; ++edge) {
            const CubeEdge e = CubeEdgeAt(edge);
            const int other = e.corner | 1 << e.axis;
            if ((configuration >> e.corner & 1) != (configuration >> other & 1))
                crossed.insert(edge);
        }
        EXPECT_EQ(used, crossed) << configuration;
    }
}

TEST(MarchingCubesTables, OneInsideCornerFacesOutward) {
    const CubeCase& cell = CubeCases()[1];
    ASSERT_EQ(cell.triangle_count, 1);
    // The x, y and z edges of corner 0: counter-clockwise when seen from (1, 1, 1).
    EXPECT_EQ(cell.triangles[0], (std::array<std::uint8_t, 3>{0, 4, 8}));
}

TEST(MarchingCubesTables, AmbiguousFaceSeparatesTheInsideCorners) {
    EXPECT_EQ(CubeCases()[0b1001].triangle_count, 2);  // corners 0 and 3, diagonal at z = 0
    EXPECT_EQ(CubeCases()[0b01101001].triangle_count, 4);
}

}  // namespace
}  // namespace tessera
