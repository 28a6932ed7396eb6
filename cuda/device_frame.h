// A frame's images on the device: prepared there from the camera's images, or copied from the
// result of PrepareFrame.
#pragma once

#include "cuda/device.h"
#include "mapping/prepared_frame.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only; `memory` and `stream` must outlive it.
class DeviceFrame {
  public:
    DeviceFrame(DeviceMemory& memory, Stream& stream);

    // Like PrepareFrame, byte for byte, but copies back only the reduced images, and the others if
    // `bring`. Returns false if there is no room; `prepared` is then unspecified.
    [[nodiscard]] bool Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                               PreparedFrame& prepared);
    // Copies what is not on the device yet. Returns false if there is no room, or if the images do
    // not exist anywhere any more.
    [[nodiscard]] bool Upload(const PreparedFrame& frame);

    // Copies PreparedFrame::gone_m to the device. Returns null if there is none, or no room.
    [[nodiscard]] const float* UploadGone(const PreparedFrame& frame);

    // Device images of the last call's frame.
    const float* depth_m() const { return depth_m_.data(); }
    const float* intensity() const { return intensity_.data(); }
    const std::uint32_t* packed_colour() const { return packed_colour_.data(); }
    // Room for the depth tiles of this image.
    float* tiles() { return tiles_.data(); }

  private:
    [[nodiscard]] bool Reserve(std::size_t pixels, bool colour);
    void Gate(const Frame& frame, const PreparedFrame::Config& config);
    void SplitColour(const ColourImage& colour, int blur_px);
    void Bring(bool bring, PreparedFrame& prepared);
    void Reduce(PreparedFrame& prepared);

    Stream& stream_;
    DeviceBuffer<float> depth_m_, intensity_, tiles_, gone_m_;
    DeviceBuffer<std::uint32_t> packed_colour_;
    std::uint64_t identity_ = 0;  // PreparedFrame::identity of these images
    // Temporary buffers.
    DeviceBuffer<float> raw_depth_m_, rough_, reduced_, extremes_;
    DeviceBuffer<Rgb8> colour_;
    DeviceBuffer<double> sum_tiles_, sums_;
};

}  // namespace tessera::TESSERA_DEVICE
