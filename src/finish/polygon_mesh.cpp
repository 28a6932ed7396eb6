#include "finish/polygon_mesh.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

using Eigen::Vector2d;
using Corners = PolygonMesh::Corners;
constexpr std::uint32_t kNobody = PolygonMesh::kNone;

// Twice the area of a, b, c; positive if counter-clockwise.
double Turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool Cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
    if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
        std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
        std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
        std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
        return false;
    return Turn(a, b, c) * Turn(a, b, d) <= 0 && Turn(c, d, a) * Turn(c, d, b) <= 0;
}

bool IsSimple(std::span<const Vector2d> p) {
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 2; k < n; ++k)
            if ((k + 1) % n != i && Cross(p[i], p[i + 1], p[k], p[(k + 1) % n])) return false;
    return true;
}

double Area(std::span<const Vector2d> p) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += Turn(p[0], p[i], p[i + 1]);
    return 0.5 * twice;
}

bool Inside(std::span<const Vector2d> p, const Vector2d& at) {
    bool inside = false;
    for (std::size_t i = 0, k = p.size() - 1; i < p.size(); k = i++)
        if ((p[i].y() > at.y()) != (p[k].y() > at.y()) &&
            at.x() < p[i].x() + (at.y() - p[i].y()) / (p[k].y() - p[i].y()) * (p[k].x() - p[i].x()))
            inside = !inside;
    return inside;
}

double DistanceFrom(std::span<const Vector2d> p, const Vector2d& at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vector2d side = p[(i + 1) % p.size()] - p[i];
        const double along = std::clamp((at - p[i]).dot(side) / side.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (p[i] + along * side - at).squaredNorm());
    }
    return std::sqrt(least);
}

std::vector<Vector2d> GridInside(std::span<const Vector2d> p, double spacing) {
    Vector2d low = p[0], high = p[0];
    for (const Vector2d& corner : p) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    spacing =
        std::max(spacing, std::sqrt((high - low).prod() / (4.0 * static_cast<double>(p.size()))));
    std::vector<Vector2d> grid;
    bool odd = false;
    for (double y = low.y() + spacing / 2; y < high.y(); y += spacing * std::sqrt(0.75)) {
        for (double x = low.x() + (odd ? spacing / 2 : 0); x < high.x(); x += spacing)
            if (Inside(p, {x, y}) && DistanceFrom(p, {x, y}) > 0.6 * spacing)
                grid.emplace_back(x, y);
        odd = !odd;
    }
    return grid;
}

// Cuts off one corner after the other: counter-clockwise triangles, or none where rounding leaves
// no corner to cut off.
std::vector<Corners> CutEars(std::span<const Vector2d> p) {
    std::vector<std::uint32_t> left(p.size());
    for (std::uint32_t i = 0; i < p.size(); ++i) left[i] = i;
    std::vector<Corners> triangles;
    const auto is_ear = [&](std::size_t i) {
        const std::size_t n = left.size();
        const std::uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
        if (Turn(p[a], p[b], p[c]) <= 0) return false;
        return std::ranges::none_of(left, [&](std::uint32_t other) {
            return other != a && other != b && other != c && Turn(p[a], p[b], p[other]) >= 0 &&
                   Turn(p[b], p[c], p[other]) >= 0 && Turn(p[c], p[a], p[other]) >= 0;
        });
    };
    std::size_t i = 0, failed = 0;
    while (left.size() > 2 && failed < left.size()) {
        const std::size_t n = left.size();
        i %= n;
        if (!is_ear(i)) {
            ++i;
            ++failed;
            continue;
        }
        triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        failed = 0;
        ++i;  // not the same fan again
    }
    if (left.size() > 2) triangles.clear();
    return triangles;
}

class DelaunayMesh {
  public:
    DelaunayMesh(std::span<const Vector2d> polygon, const std::vector<Corners>& triangles) {
        mesh_.points.assign(polygon.begin(), polygon.end());
        mesh_.triangles = triangles;
        mesh_.neighbours.assign(triangles.size(), {kNobody, kNobody, kNobody});
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            for (std::uint32_t k = 0; k < 3; ++k) Join(t, k);
        for (std::uint32_t t = 0; t < triangles.size(); ++t) suspects_.push_back(t);
        Flip();
    }

    void Insert(const Vector2d& point) {
        const std::uint32_t t = Locate(point);
        if (t == kNobody) return;
        const auto number = static_cast<std::uint32_t>(mesh_.points.size());
        mesh_.points.push_back(point);
        const Corners old = mesh_.triangles[t], beyond = mesh_.neighbours[t];
        const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
        const std::array<std::uint32_t, 3> parts{t, first, first + 1};
        mesh_.triangles.resize(first + 2);
        mesh_.neighbours.resize(first + 2);
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh_.triangles[parts[k]] = {old[k], old[(k + 1) % 3], number};
            mesh_.neighbours[parts[k]] = {beyond[k], parts[(k + 1) % 3], parts[(k + 2) % 3]};
            Replace(beyond[k], t, parts[k]);
            suspects_.push_back(parts[k]);
        }
        Flip();
    }

    PolygonMesh Take() { return std::move(mesh_); }

  private:
    const Vector2d& Point(std::uint32_t t, std::uint32_t k) const {
        return mesh_.points[mesh_.triangles[t][k % 3]];
    }

    // Finds the neighbour at an edge among the later triangles.
    void Join(std::uint32_t t, std::uint32_t k) {
        if (mesh_.neighbours[t][k] != kNobody) return;
        const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
        for (std::uint32_t o = t + 1; o < mesh_.triangles.size(); ++o)
            for (std::uint32_t m = 0; m < 3; ++m)
                if (mesh_.triangles[o][m] == b && mesh_.triangles[o][(m + 1) % 3] == a) {
                    mesh_.neighbours[t][k] = o;
                    mesh_.neighbours[o][m] = t;
                    return;
                }
    }

    void Replace(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
        if (t != kNobody) std::ranges::replace(mesh_.neighbours[t], from, to);
    }

    bool Contains(std::uint32_t t, const Vector2d& point) const {
        for (std::uint32_t k = 0; k < 3; ++k)
            if (Turn(Point(t, k), Point(t, k + 1), point) <= 0) return false;
        return true;
    }

    // The last triangle or one near it; kNobody on an edge.
    std::uint32_t Locate(const Vector2d& point) const {
        const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
        for (std::uint32_t back = 1; back <= count; ++back)
            if (Contains(count - back, point)) return count - back;
        return kNobody;
    }

    // Whether d lies within the circle through triangle a, b, c.
    static bool InCircle(const Vector2d& a, const Vector2d& b, const Vector2d& c,
                         const Vector2d& d) {
        const Vector2d u = a - d, v = b - d, w = c - d;
        const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm();
        const double det = u.x() * (v.y() * ww - vv * w.y()) - u.y() * (v.x() * ww - vv * w.x()) +
                           uu * (v.x() * w.y() - v.y() * w.x());
        return det > 1e-10 * (uu * vv + vv * ww + ww * uu);
    }

    // Turns the edges about that are not Delaunay's, from the suspects on (Lawson 1977).
    void Flip() {
        std::size_t left = 1000 + 200 * mesh_.triangles.size();  // against rounding
        while (!suspects_.empty()) {
            const std::uint32_t t = suspects_.back();
            suspects_.pop_back();
            for (std::uint32_t k = 0; k < 3; ++k)
                if (left > 0 && FlipEdge(t, k)) {
                    --left;
                    break;
                }
        }
    }

    bool FlipEdge(std::uint32_t t, std::uint32_t k) {
        const std::uint32_t o = mesh_.neighbours[t][k];
        if (o == kNobody) return false;
        std::uint32_t m = 0;
        while (m < 3 && mesh_.neighbours[o][m] != t) ++m;
        if (m == 3) return false;
        const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3],
                            c = mesh_.triangles[t][(k + 2) % 3],
                            d = mesh_.triangles[o][(m + 2) % 3];
        const auto& p = mesh_.points;
        if (!InCircle(p[a], p[b], p[c], p[d]) || Turn(p[a], p[d], p[c]) <= 0 ||
            Turn(p[d], p[b], p[c]) <= 0)
            return false;
        const std::uint32_t bc = mesh_.neighbours[t][(k + 1) % 3],
                            ca = mesh_.neighbours[t][(k + 2) % 3],
                            ad = mesh_.neighbours[o][(m + 1) % 3],
                            db = mesh_.neighbours[o][(m + 2) % 3];
        mesh_.triangles[t] = {a, d, c};
        mesh_.neighbours[t] = {ad, o, ca};
        mesh_.triangles[o] = {d, b, c};
        mesh_.neighbours[o] = {db, bc, t};
        Replace(ad, o, t);
        Replace(bc, t, o);
        suspects_.push_back(t);
        suspects_.push_back(o);
        return true;
    }

    PolygonMesh mesh_;
    std::vector<std::uint32_t> suspects_;
};

}  // namespace

std::optional<PolygonMesh> MeshPolygon(std::span<const Vector2d> polygon, double spacing) {
    if (polygon.size() < 3 || !(Area(polygon) > 0) || !IsSimple(polygon)) return std::nullopt;
    const std::vector<Corners> ears = CutEars(polygon);
    if (ears.empty()) return std::nullopt;
    DelaunayMesh mesh(polygon, ears);
    for (const Vector2d& point : GridInside(polygon, spacing)) mesh.Insert(point);
    return mesh.Take();
}

}  // namespace tessera
