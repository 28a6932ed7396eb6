// FramePoints on the device, with the formulas of tracking/point_kernels.h.
#pragma once

#include "cuda/device.h"
#include "tracking/point_kernels.h"

namespace tessera::TESSERA_DEVICE {

// Owner thread only; `memory` and `stream` outlive it.
class DevicePoints {
  public:
    DevicePoints(DeviceMemory& memory, Stream& stream);

    // The points that `arguments`, whose images are on the device, call for, in the slots and with
    // the bytes of FramePoints. How many have a weight; 0, and there are none, where there is no
    // room.
    [[nodiscard]] std::int64_t Build(const PointArguments& arguments);

    void Clear() { count_ = 0; }

    // Arrays of count(), on the device.
    int count() const { return count_; }
    const float* x() const { return x_.data(); }
    const float* y() const { return y_.data(); }
    const float* z() const { return z_.data(); }
    const float* intensity() const { return intensity_.data(); }
    const float* weight() const { return weight_.data(); }
    const float* normal_x() const {
        return normals_.data();
    }  // unspecified where none were called for
    const float* normal_y() const { return normals_.data() + count_; }
    const float* normal_z() const { return normals_.data() + 2 * count_; }

  private:
    [[nodiscard]] bool Reserve(std::size_t points, bool normals);

    Stream& stream_;
    int count_ = 0;
    DeviceBuffer<float> x_, y_, z_, intensity_, weight_, normals_;
    DeviceBuffer<double> tiles_, valid_;
};

}  // namespace tessera::TESSERA_DEVICE
