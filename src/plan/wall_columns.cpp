#include "plan/wall_columns.h"

#include <bit>

namespace tessera {
namespace {

// Bits of the bins within [low_m, high_m].
HeightBits BinsWithin(double low_m, double high_m) {
    HeightBits bits = 0;
    for (int k = 0; k < 64; ++k)
        if (k * kHeightBin_m >= low_m && (k + 1) * kHeightBin_m <= high_m)
            bits |= HeightBits{1} << k;
    return bits;
}

}  // namespace

double ColumnWidth(const PlanEvidence& evidence) {
    return std::max(0.02, 1.5 * evidence.spacing_m);
}

WallColumns ColumnsOf(const PlanEvidence& evidence, const PlanLine& line,
                      std::span<const std::uint32_t> members) {
    WallColumns columns;
    columns.width_m = ColumnWidth(evidence);
    if (members.empty()) return columns;
    const auto column_of = [&](std::uint32_t i) {
        return static_cast<std::int64_t>(
            std::floor(line.Along(evidence.upright[i].position.cast<double>()) / columns.width_m));
    };
    std::int64_t last = columns.first = column_of(members[0]);
    for (const std::uint32_t i : members) {
        columns.first = std::min(columns.first, column_of(i));
        last = std::max(last, column_of(i));
    }
    columns.bits.assign(static_cast<std::size_t>(last - columns.first + 1), 0);
    for (const std::uint32_t i : members) {
        const int bin = std::min(
            63, static_cast<int>(static_cast<double>(evidence.upright[i].height_m) / kHeightBin_m));
        columns.bits[static_cast<std::size_t>(column_of(i) - columns.first)] |= HeightBits{1}
                                                                                << bin;
    }
    return columns;
}

ColumnReader::ColumnReader(const PlanEvidence& evidence)
    : low_(BinsWithin(evidence.LowFrom_m(), evidence.LowTo_m())) {
    // What begins at the ceiling is the ceiling's.
    constexpr double kBelowCeiling_m = 0.05;
    const double top_m = evidence.ceiling_m ? *evidence.ceiling_m - kBelowCeiling_m : HUGE_VAL;
    high_ = BinsWithin(evidence.Reach_m(), top_m);
    above_ = BinsWithin(evidence.LowTo_m(), top_m);
}

bool ColumnReader::Solid(HeightBits bits) const {
    return 10 * std::popcount(bits & low_) >= 3 * std::popcount(low_) && low_ != 0;
}

bool ColumnReader::High(HeightBits bits) const { return (bits & high_) != 0; }

std::optional<double> ColumnReader::Lintel_m(HeightBits bits) const {
    const HeightBits above = bits & above_;
    if (above == 0) return std::nullopt;
    return kHeightBin_m * std::countr_zero(above);
}

}  // namespace tessera
