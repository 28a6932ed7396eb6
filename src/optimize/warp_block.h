// One block of a map whose surfaces move, resampled from where its voxels were.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mapping/block_map.h"

namespace tessera {

// How far the 3 x 3 x 3 blocks around one move, in voxels; x runs fastest, then y.
using ShiftsAround = std::array<Eigen::Vector3f, 27>;

struct WarpedBlock {
    std::array<FieldWord, kBlockVoxels> field;
    std::array<std::uint16_t, kBlockVoxels> weight;
    std::array<ColourWord, kBlockVoxels> colour;
    std::array<VoxelLabel, kBlockVoxels> label;  // unset if the map has none
    bool known = false;                          // any of its distances
};

// Resamples blocks one by one. Owner thread only; the map may be read by others.
class BlockWarper {
  public:
    explicit BlockWarper(const BlockMap& map)
        : map_(map),
          near_(static_cast<float>(2 * map.config().voxel_size_m / map.config().range_m())) {}

    // Each voxel becomes the mean of the eight of the map around the place that moves to it. It is
    // known if at least half of these are, by weight, and has the label of the nearest. Colours
    // near the surface are interpolated with cubics, which blur less. Between the centres of
    // blocks, shifts are interpolated.
    void Warp(const BlockCoord& c, const ShiftsAround& shifts, WarpedBlock& block);

  private:
    // Distance, weight, intensity, Cb, Cr, colour weight, each 0 where there is none, and whether
    // there is a distance and an intensity: what is interpolated.
    enum Part { kKnown, kDistance, kWeight, kLit, kIntensity, kCb, kCr, kColourWeight };
    using Parts = Eigen::Array<float, 8, 1>;

    bool Load(const BlockCoord& c, const ShiftsAround& shifts);
    void LoadBlock(BlockId id, const Eigen::Vector3i& corner);
    Parts Interpolate(const Eigen::Vector3f& p) const;
    void InterpolateColour(const Eigen::Vector3f& p, Eigen::Array4f& colour) const;
    VoxelLabel Nearest(const Eigen::Vector3f& p) const;

    const BlockMap& map_;
    const float near_;  // two voxels, as a distance of the field
    Eigen::Vector3f low_ = Eigen::Vector3f::Zero(), high_ = Eigen::Vector3f::Zero();
    Eigen::Vector3i first_ = Eigen::Vector3i::Zero(), size_ = Eigen::Vector3i::Zero();
    // Around the block; low_ and high_ (of the places to read) and first_ are relative to its first
    // voxel.
    std::vector<Parts> voxels_;
    std::vector<VoxelLabel> labels_;  // of these; empty if the map has none
};

}  // namespace tessera
