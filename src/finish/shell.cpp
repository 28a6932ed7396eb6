#include "finish/shell.h"

#include <numeric>
#include <vector>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

using Sides = std::vector<std::array<std::uint32_t, 3>>;

// Sets with the lowest member as their name.
class Unions {
  public:
    explicit Unions(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t Find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void Join(std::uint32_t a, std::uint32_t b) {
        a = Find(a);
        b = Find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

TriangleMesh WithoutDegenerate(const TriangleMesh& mesh) {
    TriangleMesh kept;
    kept.vertices = mesh.vertices;
    kept.colours = mesh.colours;
    for (const auto& [a, b, c] : mesh.triangles)
        if (a != b && b != c && c != a) kept.triangles.push_back({a, b, c});
    return kept;
}

// Takes apart neighbours that do not agree about inside and outside. Returns a vertex for each
// corner: corners share one if they are joined through edges.
std::vector<std::uint32_t> Weld(const TriangleMesh& mesh, Sides& neighbours) {
    Unions corners(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < neighbours.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t n = neighbours[t][k];
            if (n == kNoTriangle) continue;
            std::uint32_t m = 0;
            while (m < 3 && (neighbours[n][m] != t ||
                             mesh.triangles[n][(m + 1) % 3] != mesh.triangles[t][k] ||
                             mesh.triangles[n][m] != mesh.triangles[t][(k + 1) % 3]))
                ++m;
            if (m == 3) {
                neighbours[t][k] = kNoTriangle;
                continue;
            }
            corners.Join(3 * t + k, 3 * n + (m + 1) % 3);
            corners.Join(3 * t + (k + 1) % 3, 3 * n + m);
        }
    std::vector<std::uint32_t> vertex_of(3 * mesh.triangles.size());
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < vertex_of.size(); ++c) {
        const std::uint32_t name = corners.Find(c);
        vertex_of[c] = name == c ? count++ : vertex_of[name];
    }
    return vertex_of;
}

// The same surface, whose vertices are those of the corners.
TriangleMesh Rebuild(const TriangleMesh& mesh, const std::vector<std::uint32_t>& vertex_of) {
    TriangleMesh rebuilt;
    for (std::uint32_t c = 0; c < vertex_of.size(); ++c) {
        const std::uint32_t old = mesh.triangles[c / 3][c % 3];
        if (vertex_of[c] < rebuilt.vertices.size()) continue;
        rebuilt.vertices.push_back(mesh.vertices[old]);
        if (!mesh.colours.empty()) rebuilt.colours.push_back(mesh.colours[old]);
    }
    rebuilt.normals.assign(rebuilt.vertices.size(), Eigen::Vector3f::Zero());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<std::uint32_t, 3> triangle{vertex_of[3 * t], vertex_of[3 * t + 1],
                                                    vertex_of[3 * t + 2]};
        rebuilt.triangles.push_back(triangle);
        const Eigen::Vector3f normal = AreaNormal(rebuilt, triangle);
        for (const std::uint32_t v : triangle) rebuilt.normals[v] += normal;
    }
    for (Eigen::Vector3f& normal : rebuilt.normals) normal.normalize();
    return rebuilt;
}

// Per triangle, whether its piece has a border. Counts the pieces.
std::vector<bool> PiecesWithBorder(const Sides& neighbours, Shell& shell) {
    const auto count = static_cast<std::uint32_t>(neighbours.size());
    Unions pieces(count);
    for (std::uint32_t t = 0; t < count; ++t)
        for (const std::uint32_t n : neighbours[t])
            if (n != kNoTriangle) pieces.Join(t, n);
    std::vector<bool> open(count), open_piece(count);
    for (std::uint32_t t = 0; t < count; ++t)
        for (const std::uint32_t n : neighbours[t])
            if (n == kNoTriangle) open_piece[pieces.Find(t)] = true;
    for (std::uint32_t t = 0; t < count; ++t) {
        const std::uint32_t piece = pieces.Find(t);
        open[t] = open_piece[piece];
        if (piece == t) ++(open[t] ? shell.open_pieces : shell.closed_pieces);
    }
    return open;
}

}  // namespace

Shell MakeShell(const TriangleMesh& mesh, double thickness_m) {
    Shell shell;
    const TriangleMesh clean = WithoutDegenerate(mesh);
    Sides neighbours = TriangleNeighbours(clean);
    shell.mesh = Rebuild(clean, Weld(clean, neighbours));
    const std::vector<bool> open = PiecesWithBorder(neighbours, shell);
    TriangleMesh& body = shell.mesh;
    std::vector<std::uint32_t> back_of(body.vertices.size(), kNoTriangle);
    const auto back = [&](std::uint32_t v) {
        if (back_of[v] != kNoTriangle) return back_of[v];
        back_of[v] = static_cast<std::uint32_t>(body.vertices.size());
        const Eigen::Vector3f normal = body.normals[v];
        body.vertices.push_back(body.vertices[v] - static_cast<float>(thickness_m) * normal);
        body.normals.push_back(-normal);
        if (!body.colours.empty()) body.colours.push_back(Rgb8(body.colours[v]));
        return back_of[v];
    };
    for (std::size_t t = 0; t < open.size(); ++t) {
        if (!open[t]) continue;
        const auto front = body.triangles[t];
        body.triangles.push_back({back(front[0]), back(front[2]), back(front[1])});
        for (std::size_t k = 0; k < 3; ++k) {
            if (neighbours[t][k] != kNoTriangle) continue;
            const std::uint32_t a = front[k], b = front[(k + 1) % 3];
            body.triangles.push_back({b, a, back(a)});
            body.triangles.push_back({b, back(a), back(b)});
        }
    }
    return shell;
}

}  // namespace tessera
