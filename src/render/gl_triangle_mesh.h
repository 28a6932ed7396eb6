// A whole mesh on the GPU, drawn by the same programs as GlMeshStore. Owner thread only, with the
// same OpenGL context current in every call and on destruction.
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

    // Replaces the mesh. Without normals, each vertex gets the mean normal of its triangles.
    // `label_colours`: as in VertexMark; one per vertex or empty.
    void Set(const TriangleMesh& mesh, std::span<const Rgb8> label_colours = {});
    // Uses the attributes of GlMeshStore, with positions in metres.
    void Draw(const Eigen::Matrix4d& clip_from_camera, const Eigen::Isometry3d& T_world_camera,
              int clip_from_position) const;
    std::size_t triangles() const { return indices_ / 3; }

  private:
    GlBuffer vertex_buffer_, index_buffer_;
    unsigned vertex_array_ = 0;
    std::size_t indices_ = 0;
};

}  // namespace tessera
