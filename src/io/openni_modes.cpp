#include "io/openni_modes.h"

#include <array>
#include <cstdlib>

namespace tessera {

std::optional<std::pair<std::size_t, std::size_t>> ChooseModes(
    const std::vector<StreamMode>& depth, const std::vector<StreamMode>& colour) {
    std::optional<std::pair<std::size_t, std::size_t>> best;
    std::array<int, 3> least{};
    for (std::size_t i = 0; i < depth.size(); ++i)
        for (std::size_t j = 0; j < colour.size(); ++j) {
            const StreamMode &d = depth[i], &c = colour[j];
            if (!d.usable || !c.usable || d.width != c.width || d.height != c.height ||
                d.width < 16 || d.height < 16)
                continue;
            const std::array<int, 3> cost = {std::abs(d.width - 640) + std::abs(d.height - 480),
                                             std::abs(d.fps - 30) + std::abs(c.fps - 30),
                                             d.preference + c.preference};
            if (best && cost >= least) continue;
            best = {i, j};
            least = cost;
        }
    return best;
}

}  // namespace tessera
