// Fills a texture from frames: each texel is a weighted mean of what the views show of its place on
// the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "finish/atlas.h"
#include "finish/patch.h"
#include "finish/texture_view.h"

namespace tessera {

// Owner thread only; works on all TBB threads and gives the same bytes for any number of them.
// Takes about 50 bytes a texel.
class TextureBaker {
  public:
    // `mesh` has normals and colours, which are what no view shows gets. It is not kept.
    TextureBaker(const TriangleMesh& mesh, const std::vector<Chart>& charts, const Atlas& atlas);

    void Add(const TextureView& view);

    // Share of the texels that a view has shown.
    double SeenShare() const;
    // What lies between the charts has their mean colour.
    ColourImage Texture() const;

  private:
    struct Texel {
        Eigen::Vector3f point, normal;  // world
        std::uint32_t pixel;            // of the texture, row by row
        Rgb8 colour;                    // of the mesh
    };
    struct Piece {                // of a chart
        std::size_t first, last;  // texels
        Patch patch;
    };
    void AddTexels(const TriangleMesh& mesh, const Chart& chart, std::size_t number,
                   const Atlas& atlas, Image<std::uint8_t>& covered);
    void AddPieces(std::size_t first);

    int width_ = 0, height_ = 0;
    std::vector<Texel> texels_;
    std::vector<Eigen::Array4f> sums_;  // of weight times red, green, blue; of the weight
    std::vector<Piece> pieces_;
};

}  // namespace tessera
