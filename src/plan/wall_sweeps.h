// The Hough transform behind wall_faces: for each direction in which walls face, the upright points
// by their offset in it. Owner thread only.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "plan/plan_evidence.h"
#include "plan/plan_geometry.h"

namespace tessera {

class WallSweeps {
  public:
    static constexpr double kBin_m = 0.01;

    explicit WallSweeps(const PlanEvidence& evidence);

    struct Peak {
        std::size_t sweep = 0;
        PlanLine line;
        double area_m2 = 0;  // within one bin and a half
    };
    // The most surface in one plane that is still there.
    Peak Largest() const;
    // Points still there that lie within `reach_m` of the peak's offset and face its way.
    std::vector<std::uint32_t> Near(const Peak& peak, double reach_m) const;
    void Take(const std::vector<std::uint32_t>& points);
    // Takes what made the peak, so that it comes up no more.
    void TakePeak(const Peak& peak);

  private:
    struct Sweep {
        Eigen::Vector2d normal;
        std::int64_t first = 0;                               // bin of counts[0]
        std::vector<std::uint32_t> counts;                    // per bin
        std::vector<std::pair<float, std::uint32_t>> sorted;  // offset, point
    };
    bool Faces(const Sweep& sweep, std::uint32_t point) const;
    float OffsetOf(const Sweep& sweep, std::uint32_t point) const;
    std::int64_t BinOf(const Sweep& sweep, std::uint32_t point) const;

    const PlanEvidence& evidence_;
    std::vector<Sweep> sweeps_;
    std::vector<bool> taken_;
};

}  // namespace tessera
