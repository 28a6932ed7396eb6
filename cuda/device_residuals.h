// ResidualSums on the device, with the formulas of tracking/residual_kernels.h.
#pragma once

#include <vector>

#include "cuda/device.h"
#include "tracking/residual_kernels.h"

namespace tessera::TESSERA_DEVICE {

inline constexpr int kPointResiduals = 5;  // arrays of PointResiduals

// Owner thread only; `memory` and `stream` outlive it.
class DeviceResiduals {
  public:
    DeviceResiduals(DeviceMemory& memory, Stream& stream);

    // Room for all that points so many in a row and a column can ask for. False: there is none.
    [[nodiscard]] bool Reserve(int width, int height);
    // Of a Kind of residual_kernels.h: one group after another. The arrays are the device's.
    template <class Kind>
    void Sum(const ResidualArguments& arguments, std::vector<double>& sums);

  private:
    Stream& stream_;
    DeviceBuffer<double> parts_, sums_;
};

}  // namespace tessera::TESSERA_DEVICE
