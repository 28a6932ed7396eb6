#include "report/mesh_packing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace tessera {
namespace {

constexpr double kSteps = 65535;
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
constexpr Rgb8 kNoColour{178, 178, 178};

// Area-weighted means of the triangles' normals.
std::vector<Eigen::Vector3f> NormalsOf(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Eigen::Vector3f& p = mesh.vertices[a];
        const Eigen::Vector3f area = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p);
        if (!area.allFinite()) continue;
        for (const std::uint32_t v : {a, b, c}) normals[v] += area;
    }
    for (Eigen::Vector3f& n : normals) n.normalize();
    return normals;
}

class Packer {
  public:
    explicit Packer(const TriangleMesh& mesh) : mesh_(mesh), new_index_(mesh.vertices.size()) {
        if (mesh.normals.empty()) own_normals_ = NormalsOf(mesh);
        std::ranges::fill(new_index_, kUnused);
        CollectClasses();
    }

    PackedMesh Pack() {
        for (const auto& [a, b, c] : mesh_.triangles) {
            if (!IsFinite(a) || !IsFinite(b) || !IsFinite(c)) continue;
            for (const std::uint32_t v : {a, b, c}) AddCorner(v);
            ++packed_.triangle_count;
        }
        if (mesh_.triangles.empty())
            for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
                if (IsFinite(v)) order_.push_back(v);
        SetBox();
        packed_.vertex_count = order_.size();
        packed_.vertices.reserve(kPackedVertexBytes * order_.size());
        for (const std::uint32_t v : order_) AddVertex(v);
        return std::move(packed_);
    }

  private:
    bool IsFinite(std::uint32_t v) const { return mesh_.vertices[v].allFinite(); }

    void CollectClasses() {
        std::set<int> found;
        for (const VertexLabel& label : mesh_.labels)
            if (label.class_id != 0) found.insert(label.class_id);
        packed_.classes.assign(found.begin(), found.end());
    }

    void AddCorner(std::uint32_t v) {
        if (new_index_[v] == kUnused) {
            new_index_[v] = static_cast<std::uint32_t>(order_.size());
            order_.push_back(v);
            packed_.corners.push_back(0);
            return;
        }
        auto behind = static_cast<std::uint32_t>(order_.size()) - new_index_[v];
        for (; behind >= 128; behind >>= 7)
            packed_.corners.push_back(static_cast<std::uint8_t>(behind | 128));
        packed_.corners.push_back(static_cast<std::uint8_t>(behind));
    }

    void SetBox() {
        Eigen::AlignedBox3d box;
        for (const std::uint32_t v : order_) box.extend(mesh_.vertices[v].cast<double>());
        if (box.isEmpty()) return;
        packed_.low = box.min();
        packed_.step = box.sizes() / kSteps;
        for (double& step : packed_.step)
            if (step <= 0) step = 1;
    }

    void AddVertex(std::uint32_t v) {
        std::vector<std::uint8_t>& bytes = packed_.vertices;
        const Eigen::Vector3d code =
            (mesh_.vertices[v].cast<double>() - packed_.low).cwiseQuotient(packed_.step);
        for (int axis = 0; axis < 3; ++axis) {
            const auto whole =
                static_cast<std::uint16_t>(std::clamp(std::round(code[axis]), 0.0, kSteps));
            bytes.push_back(static_cast<std::uint8_t>(whole));
            bytes.push_back(static_cast<std::uint8_t>(whole >> 8));
        }
        const Eigen::Vector2f normal =
            OctahedralOf(own_normals_.empty() ? mesh_.normals[v] : own_normals_[v]);
        for (const float x : {normal.x(), normal.y()})
            bytes.push_back(static_cast<std::uint8_t>(
                static_cast<std::int8_t>(std::lround(127 * std::clamp(x, -1.0f, 1.0f)))));
        const Rgb8 colour = mesh_.colours.empty() ? kNoColour : mesh_.colours[v];
        bytes.insert(bytes.end(), {colour.r, colour.g, colour.b, LabelOf(v)});
    }

    std::uint8_t LabelOf(std::uint32_t v) const {
        if (mesh_.labels.empty() || mesh_.labels[v].class_id == 0) return 0;
        const auto place = std::ranges::lower_bound(packed_.classes, mesh_.labels[v].class_id);
        return static_cast<std::uint8_t>(1 + (place - packed_.classes.begin()));
    }

    const TriangleMesh& mesh_;
    std::vector<Eigen::Vector3f> own_normals_;  // if the mesh has none
    std::vector<std::uint32_t> new_index_;
    std::vector<std::uint32_t> order_;  // the mesh's vertex of each packed one
    PackedMesh packed_;
};

}  // namespace

Eigen::Vector2f OctahedralOf(const Eigen::Vector3f& normal) {
    const float length = normal.lpNorm<1>();
    if (!(length > 0) || !std::isfinite(length)) return Eigen::Vector2f::Zero();
    const Eigen::Vector3f n = normal / length;
    if (n.z() >= 0) return n.head<2>();
    const auto sign = [](float x) { return x >= 0 ? 1.0f : -1.0f; };
    return {(1 - std::abs(n.y())) * sign(n.x()), (1 - std::abs(n.x())) * sign(n.y())};
}

PackedMesh PackMesh(const TriangleMesh& mesh) { return Packer(mesh).Pack(); }

}  // namespace tessera
