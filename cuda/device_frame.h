// A frame's images on the device: made there of what the camera gave, or copied from what
// PrepareFrame made.
#pragma once

#include "cuda/device.h"
#include "mapping/prepared_frame.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only; `memory` and `stream` outlive it.
class DeviceFrame {
  public:
    DeviceFrame(DeviceMemory& memory, Stream& stream);

    // As PrepareFrame, byte for byte, but of the images only the reduced ones come back, and the
    // others if `bring`. False: no room, and `prepared` is unspecified.
    [[nodiscard]] bool Prepare(const Frame& frame, const PreparedFrame::Config& config, bool bring,
                               PreparedFrame& prepared);
    // Copies what is not here yet. False: no room, or the images are nowhere any more.
    [[nodiscard]] bool Upload(const PreparedFrame& frame);

    // PreparedFrame::gone_m there; null without one, or without room.
    [[nodiscard]] const float* UploadGone(const PreparedFrame& frame);

    // Images on the device, of the frame of the last call.
    const float* depth_m() const { return depth_m_.data(); }
    const float* intensity() const { return intensity_.data(); }
    const std::uint32_t* packed_colour() const { return packed_colour_.data(); }
    // Room for the depth tiles of that image.
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
    std::uint64_t identity_ = 0;  // whose images these are: PreparedFrame::identity
    // On the way there.
    DeviceBuffer<float> raw_depth_m_, rough_, reduced_, extremes_;
    DeviceBuffer<Rgb8> colour_;
    DeviceBuffer<double> sum_tiles_, sums_;
};

}  // namespace tessera::TESSERA_DEVICE
