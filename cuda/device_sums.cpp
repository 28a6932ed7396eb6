#include "cuda/device_sums.h"

#include "core/scalar_lanes.h"
#include "cuda/device_loops.h"
#include "tracking/icp_kernels.h"
#include "tracking/sdf_kernels.h"

namespace tessera::TESSERA_DEVICE {

namespace sum_bodies {

// Per point.
struct AddSdfPoint {
    SdfArguments arguments;

    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        SdfKernels<ScalarLanes>::AddPoints(arguments, i, sums);
    }
};

struct AddIcpPoint {
    IcpArguments arguments;

    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        IcpKernels<ScalarLanes>::AddPoints(arguments, i, sums);
    }
};

}  // namespace sum_bodies

std::size_t TilesOfPoints(int points) { return TileRoom(points, SumLayout::kCount); }

void SumSdfPoints(Stream& stream, const SdfArguments& arguments, int points, double* tiles,
                  double* sums) {
    SumTiles<SumLayout::kCount>(stream, points, sum_bodies::AddSdfPoint{arguments}, tiles, sums);
}

void SumIcpPoints(Stream& stream, const IcpArguments& arguments, int points, double* tiles,
                  double* sums) {
    SumTiles<SumLayout::kCount>(stream, points, sum_bodies::AddIcpPoint{arguments}, tiles, sums);
}

}  // namespace tessera::TESSERA_DEVICE
