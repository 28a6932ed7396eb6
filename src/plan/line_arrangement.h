// The convex cells into which lines cut a rectangle. Owner thread only.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <vector>

#include "plan/plan_geometry.h"

namespace tessera {

struct ArrangementCell {
    static constexpr int kNone = -1;
    struct Edge {               // from its corner to the next
        int line = kNone;       // kNone: the frame
        int neighbour = kNone;  // the cell on the other side
    };
    Polygon2d corners;  // counter-clockwise, metres
    std::vector<Edge> edges;
    double area_m2 = 0;

    Interval Along(std::size_t edge, const PlanLine& line) const {
        const double a = line.Along(corners[edge]),
                     b = line.Along(corners[(edge + 1) % corners.size()]);
        return {std::min(a, b), std::max(a, b)};
    }
};

class LineArrangement {
  public:
    // Time and memory grow with the square of the number of lines.
    LineArrangement(std::vector<PlanLine> lines, const Eigen::AlignedBox2d& frame);

    const std::vector<PlanLine>& lines() const { return lines_; }
    const std::vector<ArrangementCell>& cells() const { return cells_; }
    // The cell around a point; kNone outside of the frame and in what is too small for a cell.
    int Find(const Eigen::Vector2d& p) const;

  private:
    using Sides = std::vector<std::uint64_t>;  // bit per line: the point is on its normal's side
    Sides SidesOf(const Eigen::Vector2d& p) const;
    void Cut(int line);

    std::vector<PlanLine> lines_;
    Eigen::AlignedBox2d frame_;
    std::vector<ArrangementCell> cells_;
    std::map<Sides, int> by_sides_;
};

}  // namespace tessera
