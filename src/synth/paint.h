// Painted surfaces, made by program: the textures of the built-in scenes. Each is a function of its
// arguments alone (fixed seeds), so a scene looks the same on every machine. Thread-safe.
#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"

namespace tessera {

ColourImage PaintFlat(Rgb8 colour);
// Squares of two colours, `columns` x `rows` of them.
ColourImage PaintChecker(Rgb8 a, Rgb8 b, int columns, int rows, int size_px);
// Vertical stripes of several widths, repeating.
ColourImage PaintStripes(Rgb8 base, Rgb8 stripe, int size_px, std::uint64_t seed);
// Value noise of several octaves around a base colour; repeats seamlessly. contrast in grey levels.
ColourImage PaintNoise(Rgb8 base, double contrast, int size_px, std::uint64_t seed);
// Planks with grain along the image's u axis; repeats seamlessly.
ColourImage PaintWood(Rgb8 base, int planks, int size_px, std::uint64_t seed);
// Tiles with joints and a motif that varies from tile to tile; repeats seamlessly.
ColourImage PaintTiles(Rgb8 base, Rgb8 joint, int tiles, int size_px, std::uint64_t seed);
// A framed picture: hills under a sky, blocks and a caption.
ColourImage PaintPoster(const std::string& caption, int width_px, int height_px,
                        std::uint64_t seed);

// A keyboard seen from above: `rows` rows of lettered keys.
ColourImage PaintKeyboard(Rgb8 body, Rgb8 key, int width_px, int height_px, int rows);
// A monitor's face: dark rim, and a program's window with lines of coloured text and a plot.
ColourImage PaintScreen(int width_px, int height_px, std::uint64_t seed);
ColourImage PaintBookCover(const std::string& title, Rgb8 colour, int width_px, int height_px,
                           std::uint64_t seed);
ColourImage PaintBookSpine(const std::string& title, Rgb8 colour, int width_px, int height_px);
// The edges of a book's leaves.
ColourImage PaintLeaves(int width_px, int height_px, std::uint64_t seed);
// Lines of greeked text on paper.
ColourImage PaintPage(int width_px, int height_px, std::uint64_t seed);
// A mug's side: bands and dots, repeating around it.
ColourImage PaintMug(Rgb8 base, Rgb8 band, int size_px);
// A mug's top: rim and coffee.
ColourImage PaintCoffee(Rgb8 rim, int size_px);
ColourImage PaintDoor(Rgb8 colour, const std::string& plate, int width_px, int height_px);

}  // namespace tessera
