#include "render/gl_triangle_mesh.h"

#include <epoxy/gl.h>

#include <cmath>
#include <vector>

#include "render/block_geometry.h"
#include "render/gl_mesh_store.h"

namespace tessera {
namespace {

// Octahedral encoding of a vector; the shaders decode it.
std::array<std::int16_t, 2> Octahedral(Eigen::Vector3f n) {
    const float sum = n.cwiseAbs().sum();
    if (!(sum > 0)) return {0, 0};
    n /= sum;
    float x = n.x(), y = n.y();
    if (n.z() < 0) {
        x = (1 - std::abs(n.y())) * (n.x() < 0 ? -1.0f : 1.0f);
        y = (1 - std::abs(n.x())) * (n.y() < 0 ? -1.0f : 1.0f);
    }
    const auto unit = [](float v) { return static_cast<std::int16_t>(std::lround(v * 32767)); };
    return {unit(x), unit(y)};
}

std::vector<Eigen::Vector3f> MeanNormals(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Eigen::Vector3f normal =
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        for (const std::uint32_t corner : {a, b, c}) normals[corner] += normal;
    }
    return normals;
}

}  // namespace

GlTriangleMesh::GlTriangleMesh() { glGenVertexArrays(1, &vertex_array_); }

GlTriangleMesh::~GlTriangleMesh() { glDeleteVertexArrays(1, &vertex_array_); }

void GlTriangleMesh::Set(const TriangleMesh& mesh, std::span<const Rgb8> label_colours) {
    const auto normals = mesh.normals.empty() ? MeanNormals(mesh) : mesh.normals;
    std::vector<GeometryVertex> vertices(mesh.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Eigen::Vector3f& p = mesh.vertices[i];
        const bool has_colour = !mesh.colours.empty();
        vertices[i] = {{p.x(), p.y(), p.z()},
                       Octahedral(normals[i]),
                       has_colour ? mesh.colours[i] : Rgb8{},
                       static_cast<std::uint8_t>(has_colour ? 255 : 0),
                       {label_colours.empty() ? Rgb8{} : label_colours[i], 0}};
    }
    indices_ = 3 * mesh.triangles.size();
    vertex_buffer_.Reserve(vertices.size() * sizeof(vertices[0]));
    vertex_buffer_.Write(0, vertices.data(), vertices.size() * sizeof(vertices[0]));
    index_buffer_.Reserve(indices_ * sizeof(std::uint32_t));
    index_buffer_.Write(0, mesh.triangles.data(), indices_ * sizeof(std::uint32_t));
    glBindVertexArray(vertex_array_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
    SetGeometryAttributes();
    glBindVertexArray(0);
}

void GlTriangleMesh::Draw(const Eigen::Matrix4d& clip_from_camera,
                          const Eigen::Isometry3d& T_world_camera, int clip_from_position) const {
    if (indices_ == 0) return;
    const Eigen::Matrix4f clip =
        (clip_from_camera * T_world_camera.inverse().matrix()).cast<float>();
    glUniformMatrix4fv(clip_from_position, 1, GL_FALSE, clip.data());
    glBindVertexArray(vertex_array_);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices_), GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

}  // namespace tessera
