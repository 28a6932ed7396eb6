#include "plan/strip_openings.h"

#include "plan/wall_columns.h"

namespace tessera {
namespace {

// Metres. Openings are passages of a person; nothing here depends on the noise.
constexpr double kNarrowest = 0.5, kWidest = 4, kWidestWithoutLintel = 1.4;
constexpr double kCrack = 0.25;   // narrower gaps are holes of the scan
constexpr double kIsland = 0.06;  // shorter pieces of wall are noise
constexpr double kHidden = 0.5;   // a face is taken to go on behind things of this width
constexpr double kEdge = 0.08;    // an opening's side from where its face ends
constexpr double kDeepest = 0.3;  // an opening's side where only one face was seen
constexpr double kCorner = 0.12, kLongestCorner = 0.4;

enum class Gap { kWall, kOpening, kUnknown };

// Both faces' columns, along the front.
struct StripColumns {
    StripColumns(const PlanEvidence& evidence, const WallStrip& strip)
        : front(ColumnsOf(evidence, strip.front, strip.front_members)),
          back(ColumnsOf(evidence, strip.front, strip.back_members)),
          reader(evidence) {}
    HeightBits At(double along_m) const {
        const auto column = static_cast<std::int64_t>(std::floor(along_m / front.width_m));
        return front.At(column) | back.At(column);
    }
    WallColumns front, back;
    ColumnReader reader;
};

std::vector<Interval> SolidOf(const WallColumns& columns, const ColumnReader& reader) {
    std::vector<Interval> solid;
    for (std::size_t k = 0; k < columns.bits.size(); ++k)
        if (reader.Solid(columns.bits[k]))
            solid.push_back({columns.BeginOf(k), columns.BeginOf(k + 1)});
    return Joined(std::move(solid), 1e-6);
}

// Shares of a gap's length with floor through the wall, and with surface above.
struct GapEvidence {
    double floor = 0, high = 0;
    std::optional<double> lintel_m;
};

GapEvidence Look(const PlanEvidence& evidence, const WallStrip& strip, const StripColumns& columns,
                 const Interval& gap) {
    constexpr double kStep_m = 0.02, kMargin_m = 0.04;
    const double middle_m = strip.thickness_m > 0 ? strip.thickness_m / 2 : 0.075,
                 behind_m = strip.thickness_m > 0 ? strip.thickness_m + 0.05 : 0.15;
    double count = 0, floor = 0, high = 0;
    std::vector<double> lintels;
    for (double at = gap.low + kMargin_m; at < gap.high - kMargin_m; at += kStep_m) {
        const Eigen::Vector2d p = strip.front.At(at);
        ++count;
        floor += evidence.floor.Has(p - middle_m * strip.front.normal) &&
                 evidence.floor.Has(p - behind_m * strip.front.normal);
        const HeightBits bits = columns.At(at);
        high += columns.reader.High(bits);
        if (const auto lintel_m = columns.reader.Lintel_m(bits)) lintels.push_back(*lintel_m);
    }
    GapEvidence seen;
    if (count == 0) return seen;
    seen.floor = floor / count;
    seen.high = high / count;
    if (seen.high >= 0.5 && !lintels.empty()) {
        std::ranges::sort(lintels);
        seen.lintel_m = lintels[lintels.size() / 2];
    }
    return seen;
}

Gap Classify(const GapEvidence& seen, const Interval& gap, bool corner) {
    const double width = gap.Length();
    if (width <= kCrack && !corner) return Gap::kWall;
    const bool lintel = seen.high >= 0.5, floor = seen.floor >= 0.5;
    if (floor && width >= kNarrowest && width <= kWidest &&
        (lintel || (!corner && width <= kWidestWithoutLintel)))
        return Gap::kOpening;
    if (!floor && (lintel || (corner && width <= kLongestCorner))) return Gap::kWall;
    return Gap::kUnknown;
}

// The exact place of the end of a wall near `edge_m`; `side` 1: the wall lies below it. The
// opening's own side shows it best, else the outermost points of the face.
double RefineEnd(const PlanEvidence& evidence, const WallStrip& strip, double edge_m, double side) {
    constexpr float kAlong = 0.9F;
    const auto direction = strip.front.Direction().cast<float>().eval();
    const double deep_m = strip.thickness_m > 0 ? strip.thickness_m : kDeepest;
    std::vector<double> jamb, face;
    for (const UprightPoint& point : evidence.upright) {
        if (point.normal.dot(direction) * static_cast<float>(side) < kAlong) continue;
        const Eigen::Vector2d p = point.position.cast<double>();
        const double depth = strip.front.Distance(p);
        const double z = static_cast<double>(point.height_m);
        if (std::abs(strip.front.Along(p) - edge_m) < kEdge && depth < 0.02 &&
            depth > -deep_m - 0.02 && z > evidence.LowFrom_m() && z < evidence.LowTo_m())
            jamb.push_back(strip.front.Along(p));
    }
    if (static_cast<double>(jamb.size()) * std::pow(evidence.spacing_m, 2) > 0.03) {
        std::ranges::sort(jamb);
        return jamb[jamb.size() / 2];
    }
    for (const auto* members : {&strip.front_members, &strip.back_members})
        for (const std::uint32_t i : *members) {
            const double along = strip.front.Along(evidence.upright[i].position.cast<double>());
            if (std::abs(along - edge_m) < 2 * ColumnWidth(evidence) &&
                static_cast<double>(evidence.upright[i].height_m) < evidence.LowTo_m())
                face.push_back(side * along);
        }
    if (face.empty()) return edge_m;
    std::ranges::sort(face);
    return side * face[face.size() * 98 / 100];
}

double HeightOf(const StripColumns& columns) {
    std::vector<int> tops;
    for (const HeightBits bits : columns.front.bits)
        if (bits != 0) tops.push_back(64 - std::countl_zero(bits));
    if (tops.empty()) return 0;
    std::ranges::sort(tops);
    return kHeightBin_m * tops[tops.size() * 3 / 4];
}

bool SolidAt(const WallStrip& strip, double along_m) {
    return std::ranges::any_of(strip.solid, [&](const Interval& part) {
        return along_m > part.low - 0.15 && along_m < part.high + 0.15;
    });
}

// Where a wall that ends at `end_m` meets another; `side` as in RefineEnd.
std::optional<double> MeetsAt(const std::vector<WallStrip>& strips, std::size_t which, double end_m,
                              double side) {
    std::optional<double> nearest;
    for (std::size_t k = 0; k < strips.size(); ++k) {
        if (k == which) continue;
        for (const PlanLine& line : {strips[k].front, strips[k].Back()}) {
            const double at = strips[which].front.Crossing(line), beyond = side * (at - end_m);
            if (!(beyond > -kCorner && beyond < kWidest) ||
                !SolidAt(strips[k], strips[k].front.Along(strips[which].front.At(at))))
                continue;
            if (!nearest || std::abs(at - end_m) < std::abs(*nearest - end_m)) nearest = at;
        }
    }
    return nearest;
}

}  // namespace

void FindSolid(const PlanEvidence& evidence, WallStrip& strip) {
    const StripColumns columns(evidence, strip);
    const std::vector<Interval> front = SolidOf(columns.front, columns.reader),
                                back = SolidOf(columns.back, columns.reader);
    std::vector<Interval> seen = front;
    seen.insert(seen.end(), back.begin(), back.end());
    seen = Joined(std::move(seen), kIsland);
    std::erase_if(seen, [](const Interval& part) { return part.Length() < kIsland; });
    for (Interval& part : seen) {
        part = {RefineEnd(evidence, strip, part.low, -1), RefineEnd(evidence, strip, part.high, 1)};
    }
    std::vector<Interval> solid = seen;
    for (std::size_t i = 1; i < seen.size(); ++i) {
        const Interval gap{seen[i - 1].high, seen[i].low};
        const GapEvidence look = Look(evidence, strip, columns, gap);
        const Gap is = Classify(look, gap, false);
        if (is == Gap::kWall) solid.push_back(gap);
        if (is == Gap::kOpening) strip.openings.push_back({gap, look.lintel_m});
    }
    strip.solid = Joined(std::move(solid), 1e-6);
    const std::vector<Interval> front_closed = Joined(front, kHidden),
                                back_closed = Joined(back, kHidden);
    strip.both = Without(front_closed, Without(front_closed, back_closed));
    strip.front_seen = front_closed;
    strip.height_m = HeightOf(columns);
}

void JoinCorners(const PlanEvidence& evidence, std::vector<WallStrip>& strips) {
    for (std::size_t s = 0; s < strips.size(); ++s) {
        WallStrip& strip = strips[s];
        const StripColumns columns(evidence, strip);
        const std::vector<Interval> before = strip.solid;
        for (std::size_t i = 0; i < before.size(); ++i)
            for (const double side : {-1.0, 1.0}) {
                double& end = side > 0 ? strip.solid[i].high : strip.solid[i].low;
                const std::optional<double> at = MeetsAt(strips, s, end, side);
                if (!at) continue;
                const Interval gap{std::min(end, *at), std::max(end, *at)};
                if (std::abs(end - *at) <= kCorner) {
                    end = *at;
                    continue;
                }
                const bool taken = std::ranges::any_of(
                    before, [&](const Interval& other) { return other.Overlap(gap) > kIsland; });
                if (taken) continue;
                const GapEvidence look = Look(evidence, strip, columns, gap);
                const Gap is = Classify(look, gap, true);
                const bool known =
                    std::ranges::any_of(strip.openings, [&](const StripOpening& opening) {
                        return opening.along.Overlap(gap) > gap.Length() / 2;
                    });
                if (is == Gap::kOpening && !known) strip.openings.push_back({gap, look.lintel_m});
                if (is == Gap::kWall && !known) end = *at;
            }
        std::erase_if(strip.solid, [](const Interval& part) { return part.Length() <= 0; });
        strip.solid = Joined(std::move(strip.solid), 1e-6);
    }
}

}  // namespace tessera
