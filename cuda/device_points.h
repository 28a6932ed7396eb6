// FramePoints on the device, with the formulas of tracking/point_kernels.h.
#pragma once

#include "cuda/device.h"
#include "tracking/point_kernels.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only; `memory` and `stream` must outlive it.
class DevicePoints {
  public:
    DevicePoints(DeviceMemory& memory, Stream& stream);

    // Builds the points of `arguments`, whose images are on the device, in the slots and with the
    // bytes of FramePoints. Returns how many have a weight. If there is no room, there are no
    // points, and it returns 0.
    [[nodiscard]] std::int64_t Build(const PointArguments& arguments);

    void Clear() { count_ = 0; }

    // Arrays of count(), on the device.
    int count() const { return count_; }
    const float* x() const { return x_.data(); }
    const float* y() const { return y_.data(); }
    const float* z() const { return z_.data(); }
    const float* intensity() const { return intensity_.data(); }
    float* intensity() { return intensity_.data(); }
    const float* weight() const { return weight_.data(); }
    const float* cb() const { return chroma_.data(); }  // unspecified if none was requested
    const float* cr() const { return chroma_.data() + count_; }
    const float* normal_x() const { return normals_.data(); }  // unspecified if none were requested
    const float* normal_y() const { return normals_.data() + count_; }
    const float* normal_z() const { return normals_.data() + 2 * count_; }

  private:
    [[nodiscard]] bool Reserve(std::size_t points, bool normals, bool chroma);

    Stream& stream_;
    int count_ = 0;
    DeviceBuffer<float> x_, y_, z_, intensity_, weight_, normals_, chroma_;
    DeviceBuffer<double> tiles_, valid_;
};

}  // namespace tessera::TESSERA_DEVICE
