// The map's mesh on the graphics card, kept block by block, for whoever draws it: the predicted
// view and a person's window. Knows no target and no shader.
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

// Tells the vertex array in use that the bound array buffer holds GeometryVertex.
void SetGeometryAttributes();

// Owner thread only, with the same OpenGL context current in every call and on destruction. A
// program that draws it has the vertex attributes
//   layout(location = 0) in vec3 position;  // voxels; Draw sets the uniform to multiply them by
//   layout(location = 1) in vec2 normal;    // octahedral, unit is 32767; world, out of the surface
//   layout(location = 2) in vec4 colour;    // a = 0: the surface has no colour here
class GlMeshStore {
  public:
    GlMeshStore();
    ~GlMeshStore();
    GlMeshStore(const GlMeshStore&) = delete;
    GlMeshStore& operator=(const GlMeshStore&) = delete;

    // Puts these blocks in the place of what was there under their ids. The voxel size is the whole
    // mesh's: another one only after Clear.
    void Replace(double voxel_size_m, std::span<const GeometryBlock> blocks);
    // Forgets the mesh, keeps the memory.
    void Clear();

    // Draws the blocks that may be in view with the program in use, triangles counter-clockwise
    // seen from outside. `clip_from_position` is the location of its mat4 that takes positions to
    // clip space; it is set anew for each sector. Returns the number of blocks drawn.
    int Draw(const Eigen::Matrix4d& clip_from_camera, const Eigen::Isometry3d& T_world_camera,
             int clip_from_position);

    std::size_t blocks() const { return blocks_; }  // with triangles
    std::size_t triangles() const { return triangles_; }
    std::size_t bytes_used() const;  // of the card's memory, by blocks
    std::size_t bytes() const { return vertex_buffer_.capacity() + index_buffer_.capacity(); }

  private:
    // Where a block's geometry lies; empty ranges where it has no triangles.
    struct Piece {
        RangePool::Range vertices, indices;
        std::int32_t index_count = 0;
        BlockCoord coord;
    };
    // What one call draws.
    struct DrawList {
        std::vector<std::int32_t> counts, base_vertices;
        std::vector<const void*> offsets;  // bytes in the index buffer
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
