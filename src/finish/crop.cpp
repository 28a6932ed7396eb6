#include "finish/crop.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>
#include <vector>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

// Keeps what is on the inner side of one plane.
class PlaneCutter {
  public:
    // Inside: sign * coordinate >= sign * limit_m.
    PlaneCutter(TriangleMesh& mesh, int axis, float sign, float limit_m)
        : mesh_(mesh), axis_(axis), limit_m_(limit_m) {
        within_m_.reserve(mesh.vertices.size());
        for (const Eigen::Vector3f& v : mesh.vertices)
            within_m_.push_back(sign * (v[axis] - limit_m));
    }

    void Cut() {
        std::vector<Triangle> kept;
        kept.reserve(mesh_.triangles.size());
        for (const Triangle& triangle : mesh_.triangles) Cut(triangle, kept);
        mesh_.triangles = std::move(kept);
    }

  private:
    using Triangle = std::array<std::uint32_t, 3>;

    bool Inside(std::uint32_t v) const { return within_m_[v] >= 0; }

    void Cut(Triangle t, std::vector<Triangle>& kept) {
        const int inside = Inside(t[0]) + Inside(t[1]) + Inside(t[2]);
        if (inside == 3) kept.push_back(t);
        if (inside == 0 || inside == 3) return;
        // The corner that is alone on its side comes first.
        const bool alone = inside == 1;
        while (Inside(t[0]) != alone) t = {t[1], t[2], t[0]};
        const std::uint32_t ab = Between(t[0], t[1]), ac = Between(t[0], t[2]);
        const auto keep = [&](const Triangle& part) {
            if (part[0] != part[1] && part[1] != part[2] && part[2] != part[0])
                kept.push_back(part);
        };
        if (alone) {
            keep({t[0], ab, ac});
        } else {
            keep({ab, t[1], t[2]});
            keep({ab, t[2], ac});
        }
    }

    // The vertex where an edge crosses the plane: the same for both triangles that share it.
    std::uint32_t Between(std::uint32_t a, std::uint32_t b) {
        if (Inside(b)) std::swap(a, b);
        if (within_m_[a] == 0) return a;  // on the plane
        const auto [found, is_new] = made_.try_emplace(
            std::uint64_t{a} << 32 | b, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (!is_new) return found->second;
        const float share = within_m_[a] / (within_m_[a] - within_m_[b]);
        const auto mean = [&](const auto& of_a, const auto& of_b) {
            return (1 - share) * of_a + share * of_b;
        };
        mesh_.vertices.push_back(mean(mesh_.vertices[a], mesh_.vertices[b]));
        mesh_.vertices.back()[axis_] = limit_m_;
        within_m_.push_back(0);
        if (!mesh_.normals.empty())
            mesh_.normals.push_back(mean(mesh_.normals[a], mesh_.normals[b]).normalized());
        if (!mesh_.colours.empty()) {
            const Rgb8 ca = mesh_.colours[a], cb = mesh_.colours[b];
            const auto byte = [&](std::uint8_t x, std::uint8_t y) {
                return static_cast<std::uint8_t>(
                    std::lround(mean(static_cast<float>(x), static_cast<float>(y))));
            };
            mesh_.colours.push_back({byte(ca.r, cb.r), byte(ca.g, cb.g), byte(ca.b, cb.b)});
        }
        if (!mesh_.labels.empty()) mesh_.labels.push_back(VertexLabel(mesh_.labels[a]));
        return found->second;
    }

    TriangleMesh& mesh_;
    const int axis_;
    const float limit_m_;
    std::vector<float> within_m_;  // of each vertex; negative outside
    std::unordered_map<std::uint64_t, std::uint32_t> made_;
};

}  // namespace

Status CropMesh(const Eigen::AlignedBox3d& box_m, TriangleMesh& mesh) {
    Eigen::AlignedBox3f all;
    for (const Eigen::Vector3f& v : mesh.vertices) all.extend(v);
    for (int axis = 0; axis < 3; ++axis) {
        PlaneCutter(mesh, axis, 1, static_cast<float>(box_m.min()[axis])).Cut();
        PlaneCutter(mesh, axis, -1, static_cast<float>(box_m.max()[axis])).Cut();
    }
    DropUnusedVertices(mesh);
    if (!mesh.triangles.empty()) return Status::Ok();
    if (all.isEmpty()) return Status::Error("the mesh is empty");
    return Status::Error(fmt::format(
        "nothing of the mesh is in the box; the mesh is in {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} "
        "{:.2f}",
        all.min().x(), all.min().y(), all.min().z(), all.max().x(), all.max().y(), all.max().z()));
}

}  // namespace tessera
