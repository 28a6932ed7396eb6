// The floor's cells between the walls, and which of them are inside. Owner thread only.
#pragma once

#include "plan/line_arrangement.h"
#include "plan/wall_strips.h"

namespace tessera {

class RoomCells {
  public:
    RoomCells(const PlanEvidence& evidence, const std::vector<WallStrip>& strips);

    const LineArrangement& arrangement() const { return arrangement_; }
    bool Inside(int cell) const {
        return cell != ArrangementCell::kNone && inside_[static_cast<std::size_t>(cell)];
    }
    // Share of an edge that is wall or opening; 0 on the frame.
    double Walled(const ArrangementCell& cell, std::size_t edge) const;

  private:
    // What lies along each line of the arrangement.
    struct Barrier {
        std::vector<Interval> parts;  // walls and openings, joined
    };
    static LineArrangement Cut(const PlanEvidence& evidence, const std::vector<WallStrip>& strips,
                               std::vector<Barrier>& barriers);
    void FindInside(const PlanEvidence& evidence);

    std::vector<Barrier> barriers_;  // of the first lines; the others are cuts at walls' ends
    LineArrangement arrangement_;
    std::vector<bool> inside_;
};

}  // namespace tessera
