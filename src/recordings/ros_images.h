// Decodes the images of ROS messages. Content is not trusted; errors say what is wrong.
#pragma once

#include "core/image.h"
#include "core/status.h"
#include "recordings/ros_message.h"

namespace tessera {

// Whether an encoding is a depth image's ("16UC1", "mono16", "32FC1") or a colour or grey image's
// ("rgb8", "bgr8", "rgba8", "bgra8", "mono8", "8UC1", "8UC3", "yuv422", "yuv422_yuy2", "yuyv",
// "uyvy").
bool IsDepthEncoding(std::string_view encoding);
bool IsColourEncoding(std::string_view encoding);

// Depth of floats is in metres and is stored in units of 0.2 mm; see RosDepthScale.
Status DecodeRosDepth(const RosImage& message, Image<std::uint16_t>& depth);
Status DecodeRosColour(const RosImage& message, ColourImage& colour);
// Formats of compressed_depth_image_transport: PNG of 16 bits or RVL, also as inverse depth.
Status DecodeRosDepth(const RosCompressedImage& message, Image<std::uint16_t>& depth);
// JPEG or PNG.
Status DecodeRosColour(const RosCompressedImage& message, ColourImage& colour);

// Floats.
bool IsRosDepthInMetres(std::string_view encoding_or_format);
// Stored value of a metre: 1000 for integers, 5000 for floats.
double RosDepthScale(std::string_view encoding_or_format);

}  // namespace tessera
