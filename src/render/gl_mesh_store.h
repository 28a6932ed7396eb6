// The map's mesh on the GPU, stored block by block. The predicted view and the viewer window draw
// it. Independent of render targets and shaders.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "render/block_geometry.h"
#include "render/gl_buffer.h"
#include "render/range_pool.h"

namespace tessera {

// Sets up the bound vertex array to read GeometryVertex from the bound array buffer.
void SetGeometryAttributes();

// Owner thread only, with the same OpenGL context current in every call and on destruction. A
// program that draws the mesh has the vertex attributes
//   layout(location = 0) in vec3 position;  // voxels; multiply by the uniform that Draw sets
//   layout(location = 1) in vec2 normal;    // octahedral, 32767 = 1; world, out of the surface
//   layout(location = 2) in vec4 colour;    // a = 0: the surface has no colour here
//   layout(location = 3) in vec4 mark;      // VertexMark, 1 = 255
class GlMeshStore {
  public:
    GlMeshStore();
    ~GlMeshStore();
    GlMeshStore(const GlMeshStore&) = delete;
    GlMeshStore& operator=(const GlMeshStore&) = delete;

    // Replaces the blocks with these ids. The voxel size applies to the whole mesh and may change
    // only after Clear.
    void Replace(double voxel_size_m, std::span<const GeometryBlock> blocks);
    // Forgets the mesh but keeps the memory.
    void Clear();

    // Draws the blocks that may be in view with the current program. Triangles are
    // counter-clockwise seen from outside. `clip_from_position` is the location of the program's
    // mat4 from positions to clip space, which Draw sets for each sector. Returns the number of
    // blocks drawn.
    int Draw(const Eigen::Matrix4d& clip_from_camera, const Eigen::Isometry3d& T_world_camera,
             int clip_from_position);

    std::size_t blocks() const { return blocks_; }  // with triangles
    std::size_t triangles() const { return triangles_; }
    std::size_t bytes_used() const;  // GPU memory, by blocks
    std::size_t bytes() const { return vertex_buffer_.capacity() + index_buffer_.capacity(); }

  private:
    // Location of a block's geometry. The ranges are empty if it has no triangles.
    struct Piece {
        RangePool::Range vertices, indices;
        std::int32_t index_count = 0;
        BlockCoord coord;
    };
    // The blocks of one draw call.
    struct DrawList {
        std::vector<std::int32_t> counts, base_vertices;
        std::vector<const void*> offsets;  // in bytes, in the index buffer
    };

    void Place(Piece& piece, const BlockGeometry& geometry);
    void BindBuffers();
    void FillDrawLists(const Eigen::Matrix4d& clip_from_camera,
                       const Eigen::Isometry3d& T_world_camera);

    double voxel_size_m_ = 0;
    std::vector<Piece> pieces_;  // by block id
    std::size_t blocks_ = 0, triangles_ = 0;

    RangePool vertex_pool_, index_pool_;
    GlBuffer vertex_buffer_, index_buffer_;
    unsigned vertex_array_ = 0;
    std::map<BlockCoord, DrawList> draws_;  // by sector
};

}  // namespace tessera
