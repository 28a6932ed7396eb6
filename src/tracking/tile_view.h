// A depth image in tiles, each as far as its nearest pixel, from a known place: what two moments of
// a scene are compared by.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

struct TileView {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    double stamp_s = 0;
    DepthImage depth_m;  // nearest of the tile's pixels; 0 unless half of them have depth
    int blur = 0;        // tiles that an edge may have moved by while the image was taken
    // Nearest of the tiles at most 1 + blur away, 0 where depth_m is: nothing at a tile's place is
    // before it.
    DepthImage near_m;
};

// What differs by more than this between two measurements at that depth is not noise: metres.
// Structured light's noise and its slowly varying errors grow with the square of the depth.
struct DepthMargin {
    float least_m = 0.04f, per_m = 0.01f;
    float operator()(float depth_m) const { return least_m + per_m * depth_m * depth_m; }
};

// Tiles of `step` x `step` pixels of a frame whose depth is to be corrected by
// `disparity_offset_per_m`.
void MakeTiles(const DepthImage& depth_m, int step, float disparity_offset_per_m,
               DepthImage& tiles);
// The nearest of the tiles at most `reach` away in both directions; 0 where `tiles` is.
void NearestAround(const DepthImage& tiles, int reach, DepthImage& nearest);
// The same for the farthest.
void FarthestAround(const DepthImage& tiles, int reach, DepthImage& farthest);

// Marks each tile of `from` whose point lies in the free space that `to` saw. `camera` is the
// tiles'. Here as below, images have the tiles' size, and marks stay where they are set.
void MarkFree(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from);
// For each tile of `now`: the depth, from there, of the nearest surface that `past` saw in what is
// free space now.
void FindLeft(const TileView& past, const TileView& now, const PinholeCamera& camera,
              const DepthMargin& margin, DepthImage& left_m);
// Marks each tile of `from` at whose point `to` saw a surface, too.
void MarkSame(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from);
// Where a camera there sees the points of marked tiles of `from`: their depths; the others stay.
void Carry(const TileView& from, const Image<std::uint8_t>& marked,
           const Eigen::Isometry3d& T_world_camera, const PinholeCamera& camera,
           DepthImage& carried_m);

}  // namespace tessera
