// Procedural textures of the built-in scenes. Each depends only on its arguments (fixed seeds), so
// a scene looks the same on every machine. Thread-safe.
#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"

namespace tessera {

ColourImage PaintFlat(Rgb8 colour);
// A checkerboard of `columns` x `rows` squares.
ColourImage PaintChecker(Rgb8 a, Rgb8 b, int columns, int rows, int size_px);
// Vertical stripes of several widths, repeating.
ColourImage PaintStripes(Rgb8 base, Rgb8 stripe, int size_px, std::uint64_t seed);
// Value noise of several octaves around a base colour; tiles seamlessly. `contrast` in grey levels.
ColourImage PaintNoise(Rgb8 base, double contrast, int size_px, std::uint64_t seed);
// Planks with grain along the u axis of the image; tiles seamlessly.
ColourImage PaintWood(Rgb8 base, int planks, int size_px, std::uint64_t seed);
// Tiles with joints and a motif that varies from tile to tile; the image itself tiles seamlessly.
ColourImage PaintTiles(Rgb8 base, Rgb8 joint, int tiles, int size_px, std::uint64_t seed);
// A framed picture: hills below a sky, towers and a caption.
ColourImage PaintPoster(const std::string& caption, int width_px, int height_px,
                        std::uint64_t seed);

// A keyboard seen from above: `rows` rows of lettered keys.
ColourImage PaintKeyboard(Rgb8 body, Rgb8 key, int width_px, int height_px, int rows);
// The front of a monitor: dark rim, and a program window with lines of coloured text and a plot.
ColourImage PaintScreen(int width_px, int height_px, std::uint64_t seed);
ColourImage PaintBookCover(const std::string& title, Rgb8 colour, int width_px, int height_px,
                           std::uint64_t seed);
ColourImage PaintBookSpine(const std::string& title, Rgb8 colour, int width_px, int height_px);
// The edges of a book's pages.
ColourImage PaintLeaves(int width_px, int height_px, std::uint64_t seed);
// Lines of greeked text on paper.
ColourImage PaintPage(int width_px, int height_px, std::uint64_t seed);
// The side of a mug: bands and dots, repeating around it.
ColourImage PaintMug(Rgb8 base, Rgb8 band, int size_px);
// The top of a mug: rim and coffee.
ColourImage PaintCoffee(Rgb8 rim, int size_px);
ColourImage PaintDoor(Rgb8 colour, const std::string& plate, int width_px, int height_px);

}  // namespace tessera
