#include "finish/view_choice.h"

#include <utility>

#include "core/se3.h"
#include "finish/texture_view.h"

namespace tessera {

std::optional<Frame> ViewChoice::Offer(const Frame& frame) {
    const Eigen::Isometry3d& T = *frame.T_world_camera;
    const bool ends =
        best_ && ((T.translation() - T_world_first_.translation()).norm() > kStretch_m ||
                  RotationAngle(T_world_first_, T) > kStretch_rad);
    std::optional<Frame> finished;
    if (ends) finished = std::exchange(best_, std::nullopt);
    const double sharpness = Sharpness(frame.colour);
    if (!best_) T_world_first_ = T;
    if (!best_ || sharpness > best_sharpness_) {
        best_ = frame;
        best_sharpness_ = sharpness;
    }
    return finished;
}

std::optional<Frame> ViewChoice::Last() { return std::exchange(best_, std::nullopt); }

}  // namespace tessera
