// Which way is up, from the mesh alone: a run's world is its first camera, which somebody held
// tilted. Floors, tables and seats agree on a direction near that camera's up. Owner thread only.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "render/block_geometry.h"

namespace tessera {

class UpEstimator {
  public:
    // Looks for a direction within 53 degrees of `roughly_up` (any length but 0).
    explicit UpEstimator(const Eigen::Vector3d& roughly_up);

    void Clear();
    void Add(const BlockGeometry& geometry);
    void Add(const Eigen::Vector3f& normal_world);
    // Unit, world frame; nothing while too few surfaces agree.
    std::optional<Eigen::Vector3d> Up() const;

  private:
    static constexpr int kBins = 20;  // along either axis of the plane across `roughly_up`
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
