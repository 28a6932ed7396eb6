// Decodes the images of Azure Kinect recordings. Content is not trusted; errors say what is wrong.
#pragma once

#include <string_view>

#include "core/image.h"
#include "core/status.h"
#include "io/image_header.h"
#include "recordings/mkv_elements.h"

namespace tessera {

// "b16g": 16 bits for each pixel, the upper byte first.
bool IsMkvDepthFormat(std::string_view format);
// "MJPG", "NV12", "YUY2", "BGRA": all that k4arecorder writes.
bool IsMkvColourFormat(std::string_view format);

Status DecodeMkvDepth(MkvBytes bytes, ImageSize size, Image<std::uint16_t>& depth);
Status DecodeMkvColour(std::string_view format, MkvBytes bytes, ImageSize size,
                       ColourImage& colour);

}  // namespace tessera
