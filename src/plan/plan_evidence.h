// What a level surface says about walls and floor: its upright parts as points, and where floor and
// other flat surfaces were seen. Pure function, thread-safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "plan/mesh_samples.h"

namespace tessera {

// A set of squares of 5 cm. Takes memory per square, whatever its extent.
class CellSet {
  public:
    static constexpr double kSide_m = 0.05;

    void Add(const Eigen::Vector2f& p) { cells_.push_back(Key(p.cast<double>())); }
    // Keeps the squares that were added `least` times. Must precede Has and Centres.
    void Finish(double least);
    bool Has(const Eigen::Vector2d& p) const;
    std::vector<Eigen::Vector2d> Centres() const;
    std::size_t size() const { return cells_.size(); }

  private:
    static std::uint64_t Key(const Eigen::Vector2d& p);
    std::vector<std::uint64_t> cells_;  // sorted once finished
};

struct UprightPoint {
    Eigen::Vector2f position, normal;  // the normal is unit and points away from the surface
    float height_m = 0;
};

struct PlanEvidence {
    std::vector<UprightPoint> upright;  // each stands for spacing_m^2
    double spacing_m = 0;
    CellSet floor;    // where the floor was seen
    CellSet covered;  // where anything flat was seen: floor, furniture, ceiling
    std::optional<double> ceiling_m;
    double top_m = 0;  // the ceiling, or nearly the highest upright surface

    // Heights between which walls are looked at (above skirting, below lintels), and which a
    // surface must reach to be a wall and not furniture.
    double LowFrom_m() const { return 0.12 * Scale_m(); }
    double LowTo_m() const { return 0.75 * Scale_m(); }
    double Reach_m() const { return 0.8 * Scale_m(); }

  private:
    double Scale_m() const { return top_m < 2.4 ? top_m : 2.4; }
};

// `level`: z up, floor at z = 0.
PlanEvidence FindEvidence(const MeshSamples& level);

}  // namespace tessera
