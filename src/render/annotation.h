// Names, boxes and sheets for pictures that explain what the program sees. Thread-safe for
// different images.
#pragma once

#include <string>
#include <utility>

#include "core/image.h"

namespace tessera {

// A sheet of equally large images, each with its title in the upper left corner.
class PictureSheet {
  public:
    // Of images with `width` by `height` pixels.
    PictureSheet(int columns, int rows, int width, int height);

    // `tile` must have the sheet's image size.
    void Put(int column, int row, const std::string& title, const ColourImage& tile);
    ColourImage Take() { return std::move(image_); }

  private:
    int width_, height_;
    ColourImage image_;
};

// Writes a text on a plate of this colour. `middle`, `bottom`: of the plate, in pixels; parts
// outside the image are cut off.
void DrawPlate(int middle, int bottom, const std::string& text, const Rgb8& colour,
               ColourImage& image);

// Draws the outline of a rectangle, in pixels, inclusive at both ends.
void DrawRectangle(int x_min, int y_min, int x_max, int y_max, const Rgb8& colour,
                   ColourImage& image);

}  // namespace tessera
