// How well each part of the surface is measured, in three levels. They follow from the map's
// weights: one frame adds 1 at a distance of a metre (less farther away, with
// mapping.distance_weight depth_noise), and an average's error falls with the root of the sum.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/block_geometry.h"

namespace tessera {

// In [0, 255], as VertexMark::weight. Below `once`: seen once or twice. From `well` on: well
// measured. Between: thin. Pure, thread-safe.
struct CoverageLevels {
    std::uint8_t once = 0, well = 255;

    // Two and ten frames' worth: the error of one frame, and a third of it. Less where the map
    // cannot hold as much.
    static CoverageLevels Of(double max_weight);
};

// What is drawn instead of the scene's colours where it is not well measured.
inline constexpr Rgb8 kOnceColour{232, 72, 66}, kThinColour{246, 166, 48};

// Counts the vertices of a growing mesh by level. Owner thread only.
class Coverage {
  public:
    explicit Coverage(const CoverageLevels& levels) : levels_(levels) {}

    // Replaces these blocks' counts.
    void Take(std::span<const GeometryBlock> blocks);
    // Of all vertices, 0 without any.
    double well_share() const { return Share(total_.well); }
    double thin_share() const { return total_.all > 0 ? 1 - Share(total_.well) : 0; }

  private:
    struct Counts {
        std::int64_t all = 0, well = 0;
    };
    double Share(std::int64_t some) const {
        return total_.all > 0 ? static_cast<double>(some) / static_cast<double>(total_.all) : 0;
    }

    CoverageLevels levels_;
    std::vector<Counts> blocks_;  // by block id
    Counts total_;
};

}  // namespace tessera
