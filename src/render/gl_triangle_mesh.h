// A whole mesh on the graphics card, drawn by the same programs as GlMeshStore's. Owner thread
// only, with the same OpenGL context current in every call and when it is destroyed.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "core/mesh.h"
#include "render/gl_buffer.h"

namespace tessera {

class GlTriangleMesh {
  public:
    GlTriangleMesh();
    ~GlTriangleMesh();
    GlTriangleMesh(const GlTriangleMesh&) = delete;
    GlTriangleMesh& operator=(const GlTriangleMesh&) = delete;

    // Replaces what was there. Without normals the vertices get the mean of their triangles'.
    // `label_colours`: VertexMark's, one per vertex or none.
    void Set(const TriangleMesh& mesh, std::span<const Rgb8> label_colours = {});
    // With the attributes of GlMeshStore, positions in metres.
    void Draw(const Eigen::Matrix4d& clip_from_camera, const Eigen::Isometry3d& T_world_camera,
              int clip_from_position) const;
    std::size_t triangles() const { return indices_ / 3; }

  private:
    GlBuffer vertex_buffer_, index_buffer_;
    unsigned vertex_array_ = 0;
    std::size_t indices_ = 0;
};

}  // namespace tessera
