#include "render/gl_mesh_store.h"

#include <epoxy/gl.h>

#include <array>
#include <cmath>

namespace tessera {

void SetGeometryAttributes() {
    const auto attribute = [](GLuint location, GLint size, GLenum type, GLboolean normalised,
                              std::size_t offset) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, size, type, normalised, sizeof(GeometryVertex),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(GeometryVertex, position_voxels));
    attribute(1, 2, GL_SHORT, GL_FALSE, offsetof(GeometryVertex, normal));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(GeometryVertex, colour));
    attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(GeometryVertex, mark));
}

GlMeshStore::GlMeshStore() { glGenVertexArrays(1, &vertex_array_); }

GlMeshStore::~GlMeshStore() { glDeleteVertexArrays(1, &vertex_array_); }

void GlMeshStore::Clear() {
    for (Piece& piece : pieces_) {
        vertex_pool_.Free(piece.vertices);
        index_pool_.Free(piece.indices);
    }
    pieces_.clear();
    draws_.clear();
    blocks_ = triangles_ = 0;
}

std::size_t GlMeshStore::bytes_used() const {
    return vertex_pool_.used() * sizeof(GeometryVertex) +
           index_pool_.used() * sizeof(std::uint16_t);
}

void GlMeshStore::Replace(double voxel_size_m, std::span<const GeometryBlock> blocks) {
    voxel_size_m_ = voxel_size_m;
    for (const GeometryBlock& block : blocks) {
        const auto id = static_cast<std::size_t>(block.id);
        if (id >= pieces_.size()) pieces_.resize(id + 1);
        pieces_[id].coord = block.coord;
        Place(pieces_[id], block.geometry);
    }
    BindBuffers();
    for (const GeometryBlock& block : blocks) {
        const Piece& piece = pieces_[static_cast<std::size_t>(block.id)];
        if (piece.index_count == 0) continue;
        const auto& [vertices, indices] = block.geometry;
        vertex_buffer_.Write(piece.vertices.first * sizeof(vertices[0]), vertices.data(),
                             vertices.size() * sizeof(vertices[0]));
        index_buffer_.Write(piece.indices.first * sizeof(indices[0]), indices.data(),
                            indices.size() * sizeof(indices[0]));
    }
}

// Allocates the ranges that the geometry needs and frees those that it no longer needs.
void GlMeshStore::Place(Piece& piece, const BlockGeometry& geometry) {
    const auto index_count = static_cast<std::uint32_t>(geometry.indices.size());
    const auto vertex_count =
        index_count == 0 ? 0u : static_cast<std::uint32_t>(geometry.vertices.size());
    const auto place = [](RangePool& pool, RangePool::Range& range, std::uint32_t count) {
        if (RangePool::Fits(range, count)) return;
        pool.Free(range);
        range = pool.Allocate(count);
    };
    place(vertex_pool_, piece.vertices, vertex_count);
    place(index_pool_, piece.indices, index_count);
    blocks_ += static_cast<std::size_t>(index_count != 0) -
               static_cast<std::size_t>(piece.index_count != 0);
    triangles_ += index_count / 3 - static_cast<std::size_t>(piece.index_count) / 3;
    piece.index_count = static_cast<std::int32_t>(index_count);
}

// Grows the buffers if necessary, and updates the vertex array if their names changed.
void GlMeshStore::BindBuffers() {
    const bool moved = vertex_buffer_.Reserve(vertex_pool_.end() * sizeof(GeometryVertex));
    if (!index_buffer_.Reserve(index_pool_.end() * sizeof(std::uint16_t)) && !moved) return;
    glBindVertexArray(vertex_array_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
    SetGeometryAttributes();
    glBindVertexArray(0);
}

// Tests a sphere around each block against the frustum's six sides, in voxels relative to the
// camera so that no precision is lost.
void GlMeshStore::FillDrawLists(const Eigen::Matrix4d& clip_from_camera,
                                const Eigen::Isometry3d& T_world_camera) {
    Eigen::Matrix4d from_voxels = Eigen::Matrix4d::Identity();
    from_voxels.topLeftCorner<3, 3>() = T_world_camera.linear().transpose() * voxel_size_m_;
    const Eigen::Matrix4d clip = clip_from_camera * from_voxels;
    std::array<Eigen::Vector4f, 6> sides;  // not negative inside
    for (int i = 0; i < 6; ++i) {
        const Eigen::Vector4d side = clip.row(3) + (i & 1 ? -1 : 1) * clip.row(i / 2);
        sides[static_cast<std::size_t>(i)] = (side / side.head<3>().norm()).cast<float>();
    }
    const Eigen::Vector3d camera_voxels = T_world_camera.translation() / voxel_size_m_;
    constexpr float kRadius = 7;  // of a cube of 8 x 8 x 8 cells, rounded up
    for (auto& [sector, list] : draws_) {
        list.counts.clear();
        list.base_vertices.clear();
        list.offsets.clear();
    }
    for (const Piece& piece : pieces_) {
        if (piece.index_count == 0) continue;
        const Eigen::Vector3d middle(piece.coord.x * 8 + 4, piece.coord.y * 8 + 4,
                                     piece.coord.z * 8 + 4);
        const Eigen::Vector3f p = (middle - camera_voxels).cast<float>();
        bool outside = false;
        for (const Eigen::Vector4f& side : sides)
            outside |= side.head<3>().dot(p) + side.w() < -kRadius;
        if (outside) continue;
        DrawList& list = draws_[SectorOf(piece.coord)];
        list.counts.push_back(piece.index_count);
        list.base_vertices.push_back(static_cast<std::int32_t>(piece.vertices.first));
        list.offsets.push_back(
            reinterpret_cast<const void*>(piece.indices.first * sizeof(std::uint16_t)));
    }
}

int GlMeshStore::Draw(const Eigen::Matrix4d& clip_from_camera,
                      const Eigen::Isometry3d& T_world_camera, int clip_from_position) {
    FillDrawLists(clip_from_camera, T_world_camera);
    glBindVertexArray(vertex_array_);
    int drawn = 0;
    for (const auto& [sector, list] : draws_) {
        if (list.counts.empty()) continue;
        const Eigen::Vector3d origin_voxels =
            Eigen::Vector3d(sector.x, sector.y, sector.z) * kSectorBlocks * kBlockSide;
        Eigen::Isometry3d T_camera_sector = T_world_camera.inverse();
        T_camera_sector.translation() = T_camera_sector.linear() * (origin_voxels * voxel_size_m_ -
                                                                    T_world_camera.translation());
        Eigen::Matrix4d from_voxels = T_camera_sector.matrix();
        from_voxels.topLeftCorner<3, 3>() *= voxel_size_m_;
        const Eigen::Matrix4f clip = (clip_from_camera * from_voxels).cast<float>();
        glUniformMatrix4fv(clip_from_position, 1, GL_FALSE, clip.data());
        const auto count = static_cast<GLsizei>(list.counts.size());
        glMultiDrawElementsBaseVertex(GL_TRIANGLES, list.counts.data(), GL_UNSIGNED_SHORT,
                                      list.offsets.data(), count, list.base_vertices.data());
        drawn += count;
    }
    glBindVertexArray(0);
    return drawn;
}

}  // namespace tessera
