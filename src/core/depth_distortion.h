// Errors of a depth camera that depend on the place in the image. A camera that triangulates
// measures disparities; an error of those is one of the inverse depth, the same at all distances.
#pragma once

#include <vector>

#include "core/image.h"

namespace tessera {

// The error of the measured inverse depth, 1 / measured - 1 / true. Given at the centres of columns
// x rows equal parts of the image, row by row; bilinear in between, constant beyond.
struct DepthDistortion {
    int columns = 0, rows = 0;
    std::vector<float> per_m;

    bool empty() const { return per_m.empty(); }
    // At least two nodes on each side, and a finite value for each.
    bool IsValid() const;
    bool operator==(const DepthDistortion&) const = default;
};

// Where a place of the image lies between the nodes of a grid: the node at its upper left, and the
// shares of the next ones. Both sides of the grid have at least two nodes.
struct GridPlace {
    int column = 0, row = 0;
    float right = 0, below = 0;
};
GridPlace PlaceInGrid(double u_px, double v_px, int width, int height, int columns, int rows);

// Thread-safe once constructed.
class DepthCorrection {
  public:
    // For images of this size. No correction if `distortion` is empty.
    DepthCorrection(const DepthDistortion& distortion, int width, int height);

    // Takes the error from every measurement and rounds it to a multiple of 1 / units_per_m. A
    // depth that would grow tenfold is taken as no measurement. Leaves images of another size as
    // they are.
    void Apply(double units_per_m, DepthImage& depth_m) const;

  private:
    Image<float> error_per_m_;
};

}  // namespace tessera
