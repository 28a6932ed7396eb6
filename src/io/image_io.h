// Reads single images (any format OpenCV reads) and writes them (PNG or JPEG).
#pragma once

#include <string>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

// 8-bit colour or grey; PNG, JPEG, PPM ... Grey is copied to all three channels.
Result<ColourImage> ReadColourImage(const std::string& path);
// Raw values of 16-bit single-channel images only. An 8-bit or three-channel "depth" image is
// refused with an error that states its format.
Result<Image<std::uint16_t>> ReadDepthImage(const std::string& path);

// Converts depth to integers in units of 1 / units_per_m metres, rounded. Values that are not
// finite, negative or exceed 65535 units become 0, "no measurement". The storage of `stored` is
// reused.
void StoreDepth(const DepthImage& depth_m, double units_per_m, Image<std::uint16_t>& stored);

// The format follows the extension: .png, .jpg (quality 95).
Status WriteColourImage(const std::string& path, const ColourImage& image);
Status WriteDepthImage(const std::string& path, const Image<std::uint16_t>& image);
Status WriteGreyImage(const std::string& path, const Image<std::uint8_t>& image);

}  // namespace tessera
