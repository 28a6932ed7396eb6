// A wall, column by column: at which heights surface was seen along a line. Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "plan/plan_evidence.h"
#include "plan/plan_geometry.h"

namespace tessera {

inline constexpr double kHeightBin_m = 0.05;

// Bit k: surface between k and k + 1 height bins above the floor; the last bit also all above.
using HeightBits = std::uint64_t;

struct WallColumns {
    double width_m = 0.02;   // of a column
    std::int64_t first = 0;  // column k begins at (first + k) * width_m along the line
    std::vector<HeightBits> bits;

    double BeginOf(std::size_t column) const {
        return width_m * static_cast<double>(first + static_cast<std::int64_t>(column));
    }
    double End() const { return BeginOf(bits.size()); }
    HeightBits At(std::int64_t column) const {
        const std::int64_t k = column - first;
        return k < 0 || k >= static_cast<std::int64_t>(bits.size())
                   ? 0
                   : bits[static_cast<std::size_t>(k)];
    }
};

double ColumnWidth(const PlanEvidence& evidence);

// From the upright points `members` (indices), along `line`.
WallColumns ColumnsOf(const PlanEvidence& evidence, const PlanLine& line,
                      std::span<const std::uint32_t> members);

// What columns say about a wall, with the heights of the evidence.
class ColumnReader {
  public:
    explicit ColumnReader(const PlanEvidence& evidence);
    // Surface over nearly a third of the heights where nothing but a wall or furniture is.
    bool Solid(HeightBits bits) const;
    // Surface where furniture does not reach.
    bool High(HeightBits bits) const;
    // Where the surface above an opening begins.
    std::optional<double> Lintel_m(HeightBits bits) const;

  private:
    HeightBits low_ = 0, high_ = 0, above_ = 0;
};

}  // namespace tessera
