#include "mapping/marching_cubes_tables.h"

namespace tessera {
namespace {

constexpr std::uint8_t kNoEdge = 255;
constexpr int kForbidden = 1 << 20;

struct Loop {
    int size = 0;
    std::array<std::uint8_t, kCubeEdges> edges{};
};

constexpr std::uint8_t EdgeBetween(int a, int b) {
    const int corner = a & b;
    const int axis = (a ^ b) >> 1;  // 1, 2, 4 to 0, 1, 2
    const int below = (1 << axis) - 1;
    return static_cast<std::uint8_t>(4 * axis + ((corner >> 1 & ~below) | (corner & below)));
}

// Corners of a face, counter-clockwise seen from outside the cell.
constexpr std::array<int, 4> FaceCorners(int face) {
    const int axis = face / 2, side = face % 2;
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
    if (side == 1) return {base, base + u, base + u + v, base + v};
    return {base, base + v, base + u + v, base + u};
}

constexpr FaceSegments SegmentsOf(int configuration, int face) {
    const std::array<int, 4> corner = FaceCorners(face);
    const auto inside = [&](int i) { return (configuration >> corner[i & 3] & 1) != 0; };
    FaceSegments result;
    for (int first = 0; first < 4; ++first) {
        if (!inside(first) || inside(first + 3)) continue;
        int last = first;
        while (inside(last + 1)) ++last;
        result.segment[result.count++] = {EdgeBetween(corner[first], corner[(first + 3) & 3]),
                                          EdgeBetween(corner[last & 3], corner[(last + 1) & 3])};
    }
    return result;
}

// Twice the edge's midpoint, in cell coordinates.
constexpr std::array<int, 3> Middle(int edge) {
    const CubeEdge e = CubeEdgeAt(edge);
    std::array<int, 3> p{2 * (e.corner & 1), 2 * (e.corner >> 1 & 1), 2 * (e.corner >> 2)};
    p[e.axis] = 1;
    return p;
}

// Cost of a diagonal between two edges' vertices: its squared length, or kForbidden if it would lie
// in a face.
constexpr int DiagonalCost(int a, int b) {
    const std::array<int, 3> p = Middle(a), q = Middle(b);
    int length = 0;
    for (int i = 0; i < 3; ++i) {
        if (p[i] == q[i] && p[i] != 1) return kForbidden;
        length += (p[i] - q[i]) * (p[i] - q[i]);
    }
    return length;
}

// Triangulates a polygon with the shortest diagonals, by dynamic programming over its sub-polygons
// i..j.
class Triangulation {
  public:
    constexpr Triangulation(const Loop& loop, CubeCase& out) : loop_(loop), out_(out) {
        for (int span = 2; span < loop.size; ++span)
            for (int i = 0; i + span < loop.size; ++i) Solve(i, i + span);
        Emit(0, loop.size - 1);
    }

  private:
    constexpr int SideCost(int i, int j) const {
        const bool polygon_side = j == i + 1 || (i == 0 && j == loop_.size - 1);
        return polygon_side ? 0 : DiagonalCost(loop_.edges[i], loop_.edges[j]);
    }
    constexpr void Solve(int i, int j) {
        cost_[i][j] = 1 << 30;
        for (int k = i + 1; k < j; ++k) {
            const int cost = cost_[i][k] + cost_[k][j] + SideCost(i, k) + SideCost(k, j);
            if (cost >= cost_[i][j]) continue;
            cost_[i][j] = cost;
            apex_[i][j] = k;
        }
    }
    constexpr void Emit(int i, int j) {
        if (j < i + 2) return;
        const int k = apex_[i][j];
        Emit(i, k);
        out_.triangles[out_.triangle_count++] = {loop_.edges[i], loop_.edges[k], loop_.edges[j]};
        Emit(k, j);
    }

    const Loop& loop_;
    CubeCase& out_;
    int cost_[kCubeEdges][kCubeEdges] = {};
    int apex_[kCubeEdges][kCubeEdges] = {};
};

constexpr CubeCase Generate(int configuration) {
    // Each crossed edge ends one segment and starts another, on the edge's other face.
    std::array<std::uint8_t, kCubeEdges> next{};
    next.fill(kNoEdge);
    for (int face = 0; face < 6; ++face) {
        const FaceSegments s = SegmentsOf(configuration, face);
        for (int i = 0; i < s.count; ++i) next[s.segment[i][0]] = s.segment[i][1];
    }
    CubeCase result;
    for (int start = 0; start < kCubeEdges; ++start) {
        Loop loop;
        for (int edge = start; next[edge] != kNoEdge;) {
            loop.edges[loop.size++] = static_cast<std::uint8_t>(edge);
            const int following = next[edge];
            next[edge] = kNoEdge;
            edge = following;
        }
        if (loop.size > 0) Triangulation(loop, result);
    }
    return result;
}

constexpr auto GenerateAll() {
    std::array<CubeCase, kCubeConfigurations> cases{};
    for (int i = 0; i < kCubeConfigurations; ++i) cases[i] = Generate(i);
    return cases;
}

constexpr std::array<CubeCase, kCubeConfigurations> kCases = GenerateAll();

}  // namespace

FaceSegments CubeFaceSegments(int configuration, int face) {
    return SegmentsOf(configuration, face);
}

const std::array<CubeCase, kCubeConfigurations>& CubeCases() { return kCases; }

}  // namespace tessera
