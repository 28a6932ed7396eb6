#include "finish/holes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "finish/boundary_loops.h"
#include "finish/fair_heights.h"
#include "finish/mesh_edges.h"

namespace tessera {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kMostEdges = 1000;
constexpr double kLeastAgreement = 0.5;  // cosine: of the rim's normals to the plane's
constexpr double kMostAverse = 0.1;      // share of the rim that may be turned farther away
// Shares of the new surface: that frames look through, and that they have measured.
constexpr double kMostThrough = 0.25, kLeastConfirmed = 0.75;

enum class Outcome { kOuter, kLarge, kUneven, kFolded, kThrough, kClosed };

struct Patch {
    Outcome outcome = Outcome::kUneven;
    double border_m = 0, area_m2 = 0;
    TriangleMesh mesh;  // inner vertices only; indices below the loop's length are the loop's
};

class HoleCloser {
  public:
    HoleCloser(const TriangleMesh& mesh, const BoundaryLoop& loop) : mesh_(mesh), loop_(loop) {}

    Patch Close(double size_m, const FrameEvidence& evidence) {
        Patch patch;
        for (std::size_t i = 0; i < loop_.size(); ++i)
            patch.border_m += (Point(i + 1) - Point(i)).norm();
        patch.outcome = Measure(size_m);
        const bool even = patch.outcome == Outcome::kClosed;
        if (!even && (patch.outcome != Outcome::kUneven || evidence.frames() == 0)) return patch;
        if (even) patch.outcome = Outcome::kFolded;
        const std::vector<Vector2d> polygon = Flatten();
        const auto plane = MeshPolygon(polygon, patch.border_m / static_cast<double>(loop_.size()));
        if (!plane || !Raise(*plane, even, patch)) return patch;
        const Shares shares = Compare(patch, evidence);
        if (shares.through > kMostThrough)
            patch.outcome = Outcome::kThrough;
        else if (even || shares.confirmed > kLeastConfirmed)
            patch.outcome = Outcome::kClosed;
        return patch;
    }

  private:
    Vector3d Point(std::size_t i) const {
        return mesh_.vertices[loop_[i % loop_.size()]].cast<double>();
    }
    Vector3d Normal(std::size_t i) const {
        return mesh_.normals[loop_[i % loop_.size()]].cast<double>();
    }

    Outcome Measure(double size_m) {
        Vector3d area = Vector3d::Zero(), normals = Vector3d::Zero();
        for (std::size_t i = 0; i < loop_.size(); ++i) {
            centre_ += Point(i) / static_cast<double>(loop_.size());
            area += (Point(i) - Point(0)).cross(Point(i + 1) - Point(0));
            normals += Normal(i);
        }
        if (area.dot(normals) <= 0) return Outcome::kOuter;
        up_ = area.normalized();
        if (loop_.size() > kMostEdges || IsWider(size_m)) return Outcome::kLarge;
        std::size_t averse = 0;
        for (std::size_t i = 0; i < loop_.size(); ++i)
            averse += Normal(i).dot(up_) < kLeastAgreement;
        return static_cast<double>(averse) > kMostAverse * static_cast<double>(loop_.size())
                   ? Outcome::kUneven
                   : Outcome::kClosed;
    }

    bool IsWider(double size_m) const {
        for (std::size_t i = 0; i < loop_.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if ((Point(i) - Point(k)).squaredNorm() > size_m * size_m) return true;
        return false;
    }

    std::vector<Vector2d> Flatten() {
        right_ = up_.unitOrthogonal();
        ahead_ = up_.cross(right_);
        std::vector<Vector2d> polygon;
        for (std::size_t i = 0; i < loop_.size(); ++i) {
            const Vector3d p = Point(i) - centre_;
            polygon.emplace_back(p.dot(right_), p.dot(ahead_));
        }
        return polygon;
    }

    // Of the surface around, at a corner of the loop: the mean over the corners beside it.
    Vector2d Slope(std::size_t i) const {
        Vector3d normal = Vector3d::Zero();
        for (std::size_t k = i + loop_.size() - 2; k <= i + loop_.size() + 2; ++k)
            normal += Normal(k);
        const double along = std::max(normal.dot(up_), kLeastAgreement * normal.norm());
        return along > 0 ? Vector2d(-normal.dot(right_) / along, -normal.dot(ahead_) / along)
                         : Vector2d(0, 0);
    }

    bool Raise(const PolygonMesh& plane, bool even, Patch& patch) const {
        std::vector<double> rim;
        std::vector<Vector2d> slopes;
        for (std::size_t i = 0; i < loop_.size(); ++i) {
            rim.push_back((Point(i) - centre_).dot(up_));
            if (even) slopes.push_back(Slope(i));
        }
        const auto heights = FairHeights(plane, rim, slopes);
        if (!heights) return false;
        for (std::size_t i = loop_.size(); i < plane.points.size(); ++i) {
            const Vector3d p = centre_ + plane.points[i].x() * right_ +
                               plane.points[i].y() * ahead_ + (*heights)[i] * up_;
            patch.mesh.vertices.push_back(p.cast<float>());
            AddProperties(plane, i, patch.mesh);
        }
        patch.mesh.triangles = plane.triangles;
        AddNormals(patch);
        return true;
    }

    const Eigen::Vector3f& Vertex(const Patch& patch, std::uint32_t v) const {
        return v < loop_.size() ? mesh_.vertices[loop_[v]] : patch.mesh.vertices[v - loop_.size()];
    }

    void AddNormals(Patch& patch) const {
        patch.mesh.normals.assign(patch.mesh.vertices.size(), Eigen::Vector3f::Zero());
        for (const auto& triangle : patch.mesh.triangles) {
            const Eigen::Vector3f& a = Vertex(patch, triangle[0]);
            const Eigen::Vector3f normal =
                0.5f * (Vertex(patch, triangle[1]) - a).cross(Vertex(patch, triangle[2]) - a);
            patch.area_m2 += static_cast<double>(normal.norm());
            for (const std::uint32_t v : triangle)
                if (v >= loop_.size()) patch.mesh.normals[v - loop_.size()] += normal;
        }
        for (Eigen::Vector3f& normal : patch.mesh.normals) normal.normalize();
    }

    // From the rim, near corners first.
    void AddProperties(const PolygonMesh& plane, std::size_t i, TriangleMesh& patch) const {
        Eigen::Array3d colour = Eigen::Array3d::Zero();
        double sum = 0, most = 0;
        std::size_t nearest = 0;
        for (std::size_t k = 0; k < loop_.size(); ++k) {
            const double weight = 1 / ((plane.points[k] - plane.points[i]).squaredNorm() + 1e-12);
            sum += weight;
            if (weight > most) {
                most = weight;
                nearest = k;
            }
            if (mesh_.colours.empty()) continue;
            const Rgb8 c = mesh_.colours[loop_[k]];
            colour += weight * Eigen::Array3d(c.r, c.g, c.b);
        }
        colour = (colour / sum + 0.5).min(255);
        if (!mesh_.colours.empty())
            patch.colours.push_back({static_cast<std::uint8_t>(colour[0]),
                                     static_cast<std::uint8_t>(colour[1]),
                                     static_cast<std::uint8_t>(colour[2])});
        if (!mesh_.labels.empty()) patch.labels.push_back(mesh_.labels[loop_[nearest]]);
    }

    struct Shares {  // of the new surface
        double through = 0, confirmed = 0;
    };
    // At the middles of the triangles.
    Shares Compare(const Patch& patch, const FrameEvidence& evidence) const {
        Shares shares;
        for (const auto& triangle : patch.mesh.triangles) {
            const Eigen::Vector3f &a = Vertex(patch, triangle[0]), &b = Vertex(patch, triangle[1]),
                                  &c = Vertex(patch, triangle[2]);
            const Evidence there = evidence.At((a + b + c) / 3);
            const double share =
                0.5 * static_cast<double>((b - a).cross(c - a).norm()) / patch.area_m2;
            if (there.seen_through > there.confirmed) shares.through += share;
            if (there.confirmed > there.seen_through) shares.confirmed += share;
        }
        return shares;
    }

    const TriangleMesh& mesh_;
    const BoundaryLoop& loop_;
    Vector3d centre_ = Vector3d::Zero();
    Vector3d up_ = Vector3d::Zero(), right_ = Vector3d::Zero(), ahead_ = Vector3d::Zero();
};

template <class T>
void AppendTo(std::vector<T>& values, const std::vector<T>& more) {
    values.insert(values.end(), more.begin(), more.end());
}

void AppendPatch(const Patch& patch, const BoundaryLoop& loop, TriangleMesh& mesh) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto rim = static_cast<std::uint32_t>(loop.size());
    for (auto triangle : patch.mesh.triangles) {
        for (std::uint32_t& v : triangle) v = v < rim ? loop[v] : base + v - rim;
        mesh.triangles.push_back(triangle);
    }
    AppendTo(mesh.vertices, patch.mesh.vertices);
    AppendTo(mesh.normals, patch.mesh.normals);
    AppendTo(mesh.colours, patch.mesh.colours);
    AppendTo(mesh.labels, patch.mesh.labels);
}

}  // namespace

ClosedHoles CloseHoles(TriangleMesh& mesh, double size_m, const FrameEvidence& evidence) {
    const std::vector<BoundaryLoop> loops = FindBoundaryLoops(mesh);
    std::vector<Patch> patches(loops.size());
    tbb::parallel_for(std::size_t{0}, loops.size(), [&](std::size_t i) {
        patches[i] = HoleCloser(mesh, loops[i]).Close(size_m, evidence);
        if (patches[i].outcome != Outcome::kClosed) patches[i].mesh = {};
    });
    ClosedHoles holes;
    holes.loops = loops.size();
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const Patch& patch = patches[i];
        holes.border_m += patch.border_m;
        if (patch.outcome != Outcome::kOuter && patch.outcome != Outcome::kLarge)
            holes.hole_border_m += patch.border_m;
        switch (patch.outcome) {
            case Outcome::kOuter: ++holes.outer; break;
            case Outcome::kLarge: ++holes.large; break;
            case Outcome::kUneven: ++holes.uneven; break;
            case Outcome::kFolded: ++holes.folded; break;
            case Outcome::kThrough: ++holes.through; break;
            case Outcome::kClosed: {
                ++holes.closed;
                holes.closed_border_m += patch.border_m;
                holes.area_m2 += patch.area_m2;
                holes.triangles += patch.mesh.triangles.size();
                AppendPatch(patch, loops[i], mesh);
            }
        }
    }
    return holes;
}

}  // namespace tessera
