#include "plan/room_cells.h"

#include "plan/min_cut.h"

namespace tessera {
namespace {

constexpr std::size_t kMostLines = 160;  // 13,000 cells
constexpr double kFrame_m = 1;           // around everything
// Square metres of floor per metre of outline: without a wall, and along one.
constexpr double kOpenCost_m = 0.3, kWallCost_m = 0.01;

// Everything of which the plan is made.
Eigen::AlignedBox2d FrameOf(const PlanEvidence& evidence, const std::vector<WallStrip>& strips) {
    Eigen::AlignedBox2d frame;
    for (const Eigen::Vector2d& cell : evidence.floor.Centres()) frame.extend(cell);
    for (const WallStrip& strip : strips)
        for (const Interval& part : strip.solid)
            frame.extend(strip.front.At(part.low)).extend(strip.front.At(part.high));
    if (frame.isEmpty()) frame.extend(Eigen::Vector2d::Zero().eval());
    return {frame.min().array() - kFrame_m, frame.max().array() + kFrame_m};
}

// Cuts across a wall at the ends of its parts, unless a wall crosses there anyway.
void AddEnds(const std::vector<WallStrip>& strips, std::vector<PlanLine>& lines) {
    constexpr double kNear_m = 0.05;
    const std::size_t walls = lines.size();
    const auto add = [&](const WallStrip& strip, double at) {
        const bool crossed =
            std::any_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(walls),
                        [&](const PlanLine& line) {
                            return std::abs(strip.front.Crossing(line) - at) < kNear_m;
                        });
        const Eigen::Vector2d along = strip.front.Direction();
        const PlanLine end{along, along.dot(strip.front.At(at))};
        const bool known = std::ranges::any_of(lines, [&](const PlanLine& line) {
            return std::abs(line.normal.dot(along)) > 0.9999 &&
                   std::abs(line.Distance(strip.front.At(at))) < 0.01;
        });
        if (!crossed && !known && lines.size() < kMostLines) lines.push_back(end);
    };
    for (const WallStrip& strip : strips) {
        for (const Interval& part : strip.solid) add(strip, part.low), add(strip, part.high);
        for (const StripOpening& opening : strip.openings)
            add(strip, opening.along.low), add(strip, opening.along.high);
    }
}

}  // namespace

LineArrangement RoomCells::Cut(const PlanEvidence& evidence, const std::vector<WallStrip>& strips,
                               std::vector<Barrier>& barriers) {
    std::vector<PlanLine> lines;
    for (const WallStrip& strip : strips) {
        if (lines.size() + 2 > kMostLines) break;
        std::vector<Interval> parts = strip.solid;
        for (const StripOpening& opening : strip.openings) parts.push_back(opening.along);
        parts = Joined(std::move(parts), 0.02);
        lines.push_back(strip.front);
        barriers.push_back({parts});
        if (strip.thickness_m == 0) continue;
        lines.push_back(strip.Back());
        barriers.push_back({parts});
    }
    AddEnds(strips, lines);
    return {std::move(lines), FrameOf(evidence, strips)};
}

RoomCells::RoomCells(const PlanEvidence& evidence, const std::vector<WallStrip>& strips)
    : arrangement_(Cut(evidence, strips, barriers_)) {
    FindInside(evidence);
}

double RoomCells::Walled(const ArrangementCell& cell, std::size_t edge) const {
    const int line = cell.edges[edge].line;
    if (line == ArrangementCell::kNone || line >= static_cast<int>(barriers_.size())) return 0;
    const auto l = static_cast<std::size_t>(line);
    const Interval along = cell.Along(edge, arrangement_.lines()[l]);
    return along.Length() > 0 ? OverlapWith(barriers_[l].parts, along) / along.Length() : 0;
}

// Cells are inside where flat surfaces were seen. The cheapest outline follows the walls and closes
// what furniture hides.
void RoomCells::FindInside(const PlanEvidence& evidence) {
    const std::vector<ArrangementCell>& cells = arrangement_.cells();
    std::vector<double> covered_m2(cells.size());
    for (const Eigen::Vector2d& p : evidence.covered.Centres())
        if (const int cell = arrangement_.Find(p); cell != ArrangementCell::kNone)
            covered_m2[static_cast<std::size_t>(cell)] += CellSet::kSide_m * CellSet::kSide_m;
    MinCut cut(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double covered = std::min(covered_m2[i], cells[i].area_m2);
        cut.AddNode(i, covered, (cells[i].area_m2 - covered) / 2);
        for (std::size_t e = 0; e < cells[i].edges.size(); ++e) {
            const double length = (cells[i].corners[(e + 1) % cells[i].corners.size()] -
                                   cells[i].corners[e])
                                      .norm(),
                         walled = Walled(cells[i], e),
                         cost = length * (walled * kWallCost_m + (1 - walled) * kOpenCost_m);
            const int neighbour = cells[i].edges[e].neighbour;
            if (neighbour > static_cast<int>(i))
                cut.AddPair(i, static_cast<std::size_t>(neighbour), cost);
        }
    }
    inside_ = cut.Solve();
}

}  // namespace tessera
