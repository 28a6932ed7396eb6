// A printed board of squares and markers (ChArUco), for the calibration of a camera. Any part of
// it that is seen is enough.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/image.h"

namespace tessera {

// The default fits on A4 and on US Letter paper. Markers have 4 x 4 bits.
struct CalibrationBoard {
    int columns = 5, rows = 7;  // squares
    double square_m = 0.036;

    // For a printer, in true size.
    std::string Svg() const;
    // The inner corners of the squares, on the board's plane z = 0, row by row.
    std::vector<Eigen::Vector3d> Corners() const;
};

// The corners that an image shows.
struct BoardView {
    std::vector<int> ids;  // into Corners()
    std::vector<Eigen::Vector2d> pixels;
};

// Empty if the board is not seen. Corners have the precision of the image's gradients, about a
// tenth of a pixel.
BoardView FindBoard(const CalibrationBoard& board, const ColourImage& image);

}  // namespace tessera
