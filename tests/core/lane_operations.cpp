#include "lane_operations.h"

#include "core/vector_lanes.h"

namespace tessera::testing_support::TESSERA_VECTOR_NAMESPACE {

int ApplyLanes(const LaneInputs& in, LaneResults& out) {
    using Lanes = ::tessera::TESSERA_VECTOR_NAMESPACE::VectorLanes;
    static_assert(kLaneInputs % Lanes::kCount == 0);
    ApplyLaneOperations<Lanes>(in, out);
    return Lanes::kCount;
}

}  // namespace tessera::testing_support::TESSERA_VECTOR_NAMESPACE
