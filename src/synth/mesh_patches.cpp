// Cuts each triangle of the mesh scene into n^2 similar triangles, none larger than the patch size.
// Patch `2 n j - j^2 + 2 i + k` of a triangle is the k-th one (0: oriented like the triangle, 1:
// upside down) in column i of row j; u grows along i, v along j.
#include <algorithm>
#include <cmath>

#include "synth/mesh_scene.h"

namespace tessera {
namespace {

// Very large models get larger patches.
constexpr std::int64_t kMaxPatches = 20'000'000;
constexpr int kMaxDivisions = 1000;

}  // namespace

int MeshScene::Divisions(std::size_t triangle) const {
    const auto& v = model_.triangles[triangle].vertices;
    float longest = 0;
    for (int i = 0; i < 3; ++i)
        longest =
            std::max(longest, (model_.vertices[v[i]] - model_.vertices[v[(i + 1) % 3]]).norm());
    return std::clamp(static_cast<int>(std::min(std::ceil(longest / patch_m_), 1e6)), 1,
                      kMaxDivisions);
}

void MeshScene::Tessellate() {
    for (;; patch_m_ *= 2) {
        first_patch_ = {0};
        for (std::size_t i = 0; i < model_.triangles.size(); ++i) {
            const std::int64_t n = Divisions(i);
            first_patch_.push_back(first_patch_.back() + n * n);
        }
        const auto least = static_cast<std::int64_t>(model_.triangles.size());
        if (first_patch_.back() <= std::max(kMaxPatches, least)) return;
    }
}

std::int64_t MeshScene::PatchOf(const SurfaceHit& hit) const {
    const int n = Divisions(static_cast<std::size_t>(hit.part));
    const int j = std::clamp(static_cast<int>(hit.v * static_cast<float>(n)), 0, n - 1);
    const int i = std::clamp(static_cast<int>(hit.u * static_cast<float>(n)), 0, n - 1 - j);
    const float rest = (hit.u + hit.v) * static_cast<float>(n) - static_cast<float>(i + j);
    const int upside_down = rest > 1.0f && i < n - 1 - j ? 1 : 0;
    return first_patch_[hit.part] + 2ll * n * j - static_cast<std::int64_t>(j) * j + 2 * i +
           upside_down;
}

void MeshScene::AppendTriangle(std::size_t triangle, const std::vector<bool>* keep,
                               TriangleMesh& mesh) const {
    const auto& v = model_.triangles[triangle].vertices;
    const Eigen::Vector3f a = model_.vertices[v[0]], b = model_.vertices[v[1]],
                          c = model_.vertices[v[2]];
    const int n = Divisions(triangle);
    const auto corner = [&](int i, int j) -> Eigen::Vector3f {
        const float u = static_cast<float>(i) / static_cast<float>(n),
                    w = static_cast<float>(j) / static_cast<float>(n);
        return a + u * (b - a) + w * (c - a);
    };
    std::int64_t patch = first_patch_[triangle];
    for (int j = 0; j < n; ++j) {
        for (int k = 0; k < 2 * (n - j) - 1; ++k, ++patch) {
            if (keep && !(*keep)[static_cast<std::size_t>(patch)]) continue;
            const int i = k / 2;
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            if (k % 2 == 0)
                mesh.vertices.insert(mesh.vertices.end(),
                                     {corner(i, j), corner(i + 1, j), corner(i, j + 1)});
            else
                mesh.vertices.insert(mesh.vertices.end(),
                                     {corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
    }
}

TriangleMesh MeshScene::PatchMesh(const std::vector<bool>* keep) const {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < model_.triangles.size(); ++i) AppendTriangle(i, keep, mesh);
    return mesh;
}

TriangleMesh MeshScene::InstanceMesh(int instance) const {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < model_.triangles.size(); ++i)
        if (model_.triangles[i].object + 1 == instance) AppendTriangle(i, nullptr, mesh);
    return mesh;
}

}  // namespace tessera
