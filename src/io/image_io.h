// Single images in and out, as PNG (any that OpenCV reads, on the way in). The only place that
// knows OpenCV's codecs.
#pragma once

#include <string>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

// 8-bit colour or grey, PNG, JPEG, PPM ... Grey is spread over the three channels.
Result<ColourImage> ReadColourImage(const std::string& path);
// 16-bit single-channel images only: an 8-bit or three-channel "depth" is refused by name. Raw
// values.
Result<Image<std::uint16_t>> ReadDepthImage(const std::string& path);

// Depth as integers of 1 / units_per_m metres, rounded; what is not finite, negative or over 65535
// of them becomes 0, "no measurement". `stored`: its storage is reused.
void StoreDepth(const DepthImage& depth_m, double units_per_m, Image<std::uint16_t>& stored);

// By extension: .png, .jpg (quality 95).
Status WriteColourImage(const std::string& path, const ColourImage& image);
Status WriteDepthImage(const std::string& path, const Image<std::uint16_t>& image);
Status WriteGreyImage(const std::string& path, const Image<std::uint8_t>& image);

}  // namespace tessera
