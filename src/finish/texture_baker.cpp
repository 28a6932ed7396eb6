#include "finish/texture_baker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "finish/cover.h"

namespace tessera {
namespace {

constexpr float kGutter = Atlas::kMargin - 0.5f;  // bilinear filtering reads a texel beyond
constexpr std::size_t kPieceTexels = 4096;

Rgb8 ToRgb(const Eigen::Array3f& c) {
    const auto byte = [](float x) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0f, 255.0f)));
    };
    return {byte(c[0]), byte(c[1]), byte(c[2])};
}

}  // namespace

TextureBaker::TextureBaker(const TriangleMesh& mesh, const std::vector<Chart>& charts,
                           const Atlas& atlas)
    : width_(atlas.width), height_(atlas.height) {
    Image<std::uint8_t> covered(width_, height_, 0);
    for (std::size_t number = 0; number < charts.size(); ++number) {
        const std::size_t first = texels_.size();
        AddTexels(mesh, charts[number], number, atlas, covered);
        AddPieces(first);
    }
    sums_.assign(texels_.size(), Eigen::Array4f::Zero());
}

// First what the triangles cover, then their gutter.
void TextureBaker::AddTexels(const TriangleMesh& mesh, const Chart& chart, std::size_t number,
                             const Atlas& atlas, Image<std::uint8_t>& covered) {
    for (const float margin : {1e-3f, kGutter})
        for (const std::uint32_t t : chart.triangles) {
            const auto& triangle = mesh.triangles[t];
            std::array<Eigen::Vector2f, 3> corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = atlas.TexelOf(chart, number, mesh.vertices[triangle[k]]);
            ForEachCovered(corners, margin, [&](int x, int y, const Eigen::Vector3f& weights) {
                if (!covered.Contains(x, y) || covered(x, y) != 0) return;
                covered(x, y) = 1;
                Texel texel{Eigen::Vector3f::Zero(),
                            Eigen::Vector3f::Zero(),
                            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width_) +
                                static_cast<std::uint32_t>(x),
                            {}};
                Eigen::Array3f colour = Eigen::Array3f::Zero();
                for (std::size_t k = 0; k < 3; ++k) {
                    const float weight = weights[static_cast<Eigen::Index>(k)];
                    texel.point += weight * mesh.vertices[triangle[k]];
                    texel.normal += weight * mesh.normals[triangle[k]];
                    colour += weight * ToArray(mesh.colours[triangle[k]]);
                }
                texel.normal.normalize();
                texel.colour = ToRgb(colour);
                texels_.push_back(texel);
            });
        }
}

void TextureBaker::AddPieces(std::size_t first) {
    for (std::size_t i = first; i < texels_.size(); i += kPieceTexels) {
        const std::size_t last = std::min(i + kPieceTexels, texels_.size());
        pieces_.push_back({i, last, PatchOf(std::span(texels_).subspan(i, last - i))});
    }
}

void TextureBaker::Add(const TextureView& view) {
    tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t i) {
        const Piece& piece = pieces_[i];
        if (!MayShow(view, piece.patch)) return;
        for (std::size_t k = piece.first; k < piece.last; ++k) {
            const SeenColour seen = See(view, texels_[k].point, texels_[k].normal);
            if (seen.weight <= 0) continue;
            sums_[k].head<3>() += seen.weight * view.gain * seen.rgb;
            sums_[k][3] += seen.weight;
        }
    });
}

double TextureBaker::SeenShare() const {
    const auto seen = std::ranges::count_if(sums_, [](const auto& sum) { return sum[3] > 0; });
    return sums_.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(sums_.size());
}

ColourImage TextureBaker::Texture() const {
    Eigen::Array3d mean = Eigen::Array3d::Zero();
    std::vector<Rgb8> colours(texels_.size());
    for (std::size_t k = 0; k < texels_.size(); ++k) {
        colours[k] = sums_[k][3] > 0 ? ToRgb(sums_[k].head<3>() / sums_[k][3]) : texels_[k].colour;
        mean += ToArray(colours[k]).cast<double>();
    }
    if (!colours.empty()) mean /= static_cast<double>(colours.size());
    ColourImage texture(width_, height_, ToRgb(mean.cast<float>()));
    for (std::size_t k = 0; k < texels_.size(); ++k) texture.data()[texels_[k].pixel] = colours[k];
    return texture;
}

}  // namespace tessera
