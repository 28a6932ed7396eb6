#include "plan/plan_evidence.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr float kFlat = 0.94F;     // cosine of 20 degrees
constexpr float kUpright = 0.42F;  // sine of 25 degrees
constexpr double kFloorBand_m = 0.1, kFurniture_m = 1.4, kLowestCeiling_m = 1.8;

// The height of the largest surface that faces down, above all that a person stands under.
std::optional<double> CeilingOf(const MeshSamples& level, std::size_t floor_points) {
    constexpr double kStep_m = 0.02, kBand_m = 0.04, kLeastShare = 0.05;
    std::map<int, std::size_t> layers;
    const auto faces_down = [&](std::size_t i) {
        return level.surface.normals[i].z() < -kFlat &&
               level.surface.vertices[i].z() > static_cast<float>(kLowestCeiling_m);
    };
    for (std::size_t i = 0; i < level.surface.vertices.size(); ++i)
        if (faces_down(i))
            ++layers[static_cast<int>(std::floor(level.surface.vertices[i].z() / kStep_m))];
    const auto largest =
        std::ranges::max_element(layers, {}, [](const auto& layer) { return layer.second; });
    if (largest == layers.end()) return std::nullopt;
    const double about_m = kStep_m * (largest->first + 0.5);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < level.surface.vertices.size(); ++i) {
        const double z = static_cast<double>(level.surface.vertices[i].z());
        if (!faces_down(i) || std::abs(z - about_m) > kBand_m) continue;
        sum += z;
        ++count;
    }
    if (static_cast<double>(count) < kLeastShare * static_cast<double>(floor_points))
        return std::nullopt;
    return sum / static_cast<double>(count);
}

// Nearly the highest: the highest hundredth may be noise.
double TopOf(const std::vector<UprightPoint>& points) {
    if (points.empty()) return 0;
    std::vector<float> heights;
    for (const UprightPoint& point : points) heights.push_back(point.height_m);
    return static_cast<double>(Quantile(heights, 0.99));
}

}  // namespace

std::uint64_t CellSet::Key(const Eigen::Vector2d& p) {
    const auto index = [](double x) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / kSide_m)) +
                                          (std::int64_t{1} << 31));
    };
    return index(p.x()) << 32 | index(p.y());
}

void CellSet::Finish(double least) {
    std::ranges::sort(cells_);
    std::size_t kept = 0;
    for (std::size_t i = 0, next = 0; i < cells_.size(); i = next) {
        while (next < cells_.size() && cells_[next] == cells_[i]) ++next;
        if (static_cast<double>(next - i) >= least) cells_[kept++] = cells_[i];
    }
    cells_.resize(kept);
}

bool CellSet::Has(const Eigen::Vector2d& p) const {
    return std::binary_search(cells_.begin(), cells_.end(), Key(p));
}

std::vector<Eigen::Vector2d> CellSet::Centres() const {
    const auto centre = [](std::uint64_t index) {
        return kSide_m *
               (static_cast<double>(static_cast<std::int64_t>(index) - (std::int64_t{1} << 31)) +
                0.5);
    };
    std::vector<Eigen::Vector2d> centres;
    for (const std::uint64_t cell : cells_)
        centres.emplace_back(centre(cell >> 32), centre(cell & 0xffffffffU));
    return centres;
}

PlanEvidence FindEvidence(const MeshSamples& level) {
    PlanEvidence evidence;
    evidence.spacing_m = level.spacing_m;
    std::size_t floor_points = 0;
    for (std::size_t i = 0; i < level.surface.vertices.size(); ++i) {
        const Eigen::Vector3f &p = level.surface.vertices[i], &n = level.surface.normals[i];
        const double z = static_cast<double>(p.z());
        if (std::abs(n.z()) < kUpright) {
            if (z > 0) evidence.upright.push_back({p.head<2>(), n.head<2>().normalized(), p.z()});
        } else if (n.z() > kFlat && std::abs(z) < kFloorBand_m) {
            evidence.floor.Add(p.head<2>());
            evidence.covered.Add(p.head<2>());
            ++floor_points;
        } else if ((n.z() > kFlat && z > 0 && z < kFurniture_m) ||
                   (n.z() < -kFlat && z > kLowestCeiling_m)) {
            evidence.covered.Add(p.head<2>());
        }
    }
    // A fifth of a square, and at least one point.
    const double per_cell = CellSet::kSide_m * CellSet::kSide_m / std::pow(level.spacing_m, 2);
    evidence.floor.Finish(std::max(1.0, 0.2 * per_cell));
    evidence.covered.Finish(std::max(1.0, 0.2 * per_cell));
    evidence.ceiling_m = CeilingOf(level, floor_points);
    evidence.top_m = evidence.ceiling_m.value_or(TopOf(evidence.upright));
    return evidence;
}

}  // namespace tessera
