// ResidualSums on the device, with the formulas of tracking/residual_kernels.h.
#pragma once

#include <vector>

#include "cuda/device.h"
#include "tracking/residual_kernels.h"
#include "tracking/shading_kernels.h"

namespace tessera::TESSERA_DEVICE {

inline constexpr int kPointResiduals = 5;  // number of arrays of PointResiduals

// Owner thread only; `memory` and `stream` must outlive it.
class DeviceResiduals {
  public:
    DeviceResiduals(DeviceMemory& memory, Stream& stream);

    // Makes room for all sums over this many points per row and column. False: there is none.
    [[nodiscard]] bool Reserve(int width, int height);
    // Sums of a Kind of residual_kernels.h, group by group. The arrays of the arguments are on the
    // device.
    template <class Kind>
    void Sum(const ResidualArguments& arguments, std::vector<double>& sums);
    // RemoveShading for arguments whose points and residuals are on the device.
    void RemoveShading(ShadingArguments arguments);

  private:
    Stream& stream_;
    DeviceBuffer<double> parts_, sums_;
    DeviceBuffer<float> patches_;  // sums, numbers and means
};

}  // namespace tessera::TESSERA_DEVICE
