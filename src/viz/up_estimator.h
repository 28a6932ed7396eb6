// Estimates the up direction from the mesh alone. The world frame of a run is its first camera,
// which is usually tilted. Floors, tables and seats share a direction near that camera's up. Owner
// thread only.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "render/block_geometry.h"

namespace tessera {

class UpEstimator {
  public:
    // Searches within 53 degrees of `roughly_up` (any non-zero length).
    explicit UpEstimator(const Eigen::Vector3d& roughly_up);

    void Add(const BlockGeometry& geometry);
    void Add(const Eigen::Vector3f& normal_world);
    // Unit vector in the world frame; empty while too few surfaces agree.
    std::optional<Eigen::Vector3d> Up() const;

  private:
    static constexpr int kBins = 20;  // along both axes of the plane perpendicular to `roughly_up`
    struct Bin {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double count = 0;
    };
    const Bin& At(int x, int y) const { return bins_[static_cast<std::size_t>(y * kBins + x)]; }

    Eigen::Vector3f rough_, east_, north_;
    std::array<Bin, kBins * kBins> bins_;
    double count_ = 0;
};

}  // namespace tessera
