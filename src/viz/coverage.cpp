#include "viz/coverage.h"

#include <algorithm>

#include "render/vertex_weight.h"

namespace tessera {

CoverageLevels CoverageLevels::Of(double max_weight) {
    const auto step = [](double weight) { return WeightStep(static_cast<float>(weight)); };
    return {step(std::min(2.0, max_weight / 10)), step(std::min(10.0, max_weight / 2))};
}

void Coverage::Take(std::span<const GeometryBlock> blocks) {
    for (const GeometryBlock& block : blocks) {
        Counts now;
        for (const GeometryVertex& vertex : block.geometry.vertices) {
            ++now.all;
            now.well += vertex.mark.weight >= levels_.well;
        }
        const auto id = static_cast<std::size_t>(block.id);
        if (id >= blocks_.size()) blocks_.resize(id + 1);
        Counts& counts = blocks_[id];
        total_.all += now.all - counts.all;
        total_.well += now.well - counts.well;
        counts = now;
    }
}

}  // namespace tessera
