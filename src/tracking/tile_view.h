// A depth image in tiles, each with the depth of its nearest pixel, from a known pose. Two frames
// of a scene are compared by these.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/block_map.h"

namespace tessera {

struct TileView {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    double stamp_s = 0;
    DepthImage depth_m;  // of the tile's nearest pixel; 0 unless half of the pixels have depth
    int blur = 0;        // tiles by which an edge may have moved while the image was taken
    // The nearest of the tiles at most 1 + blur away, 0 where depth_m is 0: nothing at a tile's
    // position is in front of this depth.
    DepthImage near_m;
    BlockId map_end = 0;  // blocks below this id are older, but for ids that paging gave again
};

// Two measurements at a depth that differ by more than this, in metres, differ by more than noise.
// Structured light's noise and its slowly varying errors grow with the square of the depth.
struct DepthMargin {
    float least_m = 0.04f, per_m = 0.01f;
    float operator()(float depth_m) const { return least_m + per_m * depth_m * depth_m; }
};

// Makes tiles of `step` x `step` pixels from a frame, whose depth is corrected by
// `disparity_offset_per_m`.
void MakeTiles(const DepthImage& depth_m, int step, float disparity_offset_per_m,
               DepthImage& tiles);
// The nearest of the tiles at most `reach` away in both directions; 0 where `tiles` is 0.
void NearestInWindow(const DepthImage& tiles, int reach, DepthImage& nearest);
// The same for the farthest.
void FarthestInWindow(const DepthImage& tiles, int reach, DepthImage& farthest);

// Marks each tile of `from` whose point lies in the free space that `to` saw. `camera` is that of
// the tile images. Here and below, images have the size of the tile images, and existing marks
// stay.
void MarkFree(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from);
// For each tile of `now`: the depth, seen from `now`, of the nearest surface that `past` saw in
// what is free space now.
void FindDeparted(const TileView& past, const TileView& now, const PinholeCamera& camera,
                  const DepthMargin& margin, DepthImage& left_m);
// Marks each tile of `from` at whose point `to` also saw a surface.
void MarkSame(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from);
// Projects the points of marked tiles of `from` into a camera at this pose and enters their depths.
// Other depths stay.
void ReprojectMarks(const TileView& from, const Image<std::uint8_t>& marked,
                    const Eigen::Isometry3d& T_world_camera, const PinholeCamera& camera,
                    DepthImage& carried_m);

}  // namespace tessera
