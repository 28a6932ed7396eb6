#include "plan/line_arrangement.h"

#include <utility>

namespace tessera {
namespace {

constexpr double kOnLine_m = 1e-5;
constexpr double kLeastCell_m2 = 1e-6;

Eigen::Vector2d Middle(const Polygon2d& corners) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

// The part of the cell on the side of the normal (`side` 1) or the other (-1).
ArrangementCell Part(const ArrangementCell& cell, const std::vector<double>& distances, double side,
                     int line) {
    ArrangementCell part;
    const auto add = [&](const Eigen::Vector2d& corner, int on) {
        part.corners.push_back(corner);
        part.edges.push_back({on, ArrangementCell::kNone});
    };
    for (std::size_t i = 0; i < cell.corners.size(); ++i) {
        const std::size_t next = (i + 1) % cell.corners.size();
        const double here = side * distances[i], there = side * distances[next];
        if (here >= 0) add(cell.corners[i], here == 0 && there < 0 ? line : cell.edges[i].line);
        if (here * there < 0) {
            const Eigen::Vector2d crossing =
                cell.corners[i] + here / (here - there) * (cell.corners[next] - cell.corners[i]);
            add(crossing, here > 0 ? line : cell.edges[i].line);
        }
    }
    part.area_m2 = SignedArea(part.corners);
    return part;
}

}  // namespace

LineArrangement::LineArrangement(std::vector<PlanLine> lines, const Eigen::AlignedBox2d& frame)
    : lines_(std::move(lines)), frame_(frame) {
    using Corner = Eigen::AlignedBox2d;
    ArrangementCell all;
    for (const auto corner :
         {Corner::BottomLeft, Corner::BottomRight, Corner::TopRight, Corner::TopLeft})
        all.corners.push_back(frame.corner(corner));
    all.edges.resize(4);
    all.area_m2 = frame.volume();
    cells_.push_back(std::move(all));
    for (int line = 0; line < static_cast<int>(lines_.size()); ++line) Cut(line);
    for (std::size_t i = 0; i < cells_.size(); ++i)
        by_sides_[SidesOf(Middle(cells_[i].corners))] = static_cast<int>(i);
    for (ArrangementCell& cell : cells_)
        for (std::size_t i = 0; i < cell.edges.size(); ++i) {
            if (cell.edges[i].line == ArrangementCell::kNone) continue;
            const Eigen::Vector2d &a = cell.corners[i],
                                  &b = cell.corners[(i + 1) % cell.corners.size()];
            const Eigen::Vector2d out = Eigen::Vector2d(b.y() - a.y(), a.x() - b.x()).normalized();
            cell.edges[i].neighbour = Find((a + b) / 2 + 2 * kOnLine_m * out);
        }
}

void LineArrangement::Cut(int line) {
    std::vector<ArrangementCell> parts;
    for (ArrangementCell& cell : cells_) {
        std::vector<double> distances;
        for (const Eigen::Vector2d& corner : cell.corners) {
            const double distance = lines_[static_cast<std::size_t>(line)].Distance(corner);
            distances.push_back(std::abs(distance) < kOnLine_m ? 0 : distance);
        }
        const auto [low, high] = std::ranges::minmax(distances);
        if (low >= 0 || high <= 0) {
            parts.push_back(std::move(cell));
            continue;
        }
        for (const double side : {1.0, -1.0})
            if (ArrangementCell part = Part(cell, distances, side, line);
                part.area_m2 > kLeastCell_m2)
                parts.push_back(std::move(part));
    }
    cells_ = std::move(parts);
}

LineArrangement::Sides LineArrangement::SidesOf(const Eigen::Vector2d& p) const {
    Sides sides(lines_.size() / 64 + 1, 0);
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (lines_[i].Distance(p) > 0) sides[i / 64] |= std::uint64_t{1} << (i % 64);
    return sides;
}

int LineArrangement::Find(const Eigen::Vector2d& p) const {
    if (!frame_.contains(p)) return ArrangementCell::kNone;
    const auto found = by_sides_.find(SidesOf(p));
    return found == by_sides_.end() ? ArrangementCell::kNone : found->second;
}

}  // namespace tessera
