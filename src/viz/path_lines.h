// Lines of the 3D view: the path coloured by tracking quality or, in a replay, as far as it has
// been walked; the ground truth; the sensor's outline. Made, used and destroyed with the OpenGL
// context current.
#pragma once

#include <optional>
#include <vector>

#include "viz/gl_lines.h"
#include "viz/viewer_state.h"

namespace tessera {

class PathLines {
  public:
    // Shows a fixed path instead of the system's.
    void SetPath(const std::vector<Eigen::Isometry3d>& path);
    // Takes over what is new. True if anything changed.
    bool Update(const ViewerState& state);
    void Draw(const GlLineProgram& program, const GlLineProgram::View& view, bool with_truth,
              float opacity);

  private:
    void SetOutline(const Eigen::Isometry3d& T_world_camera, const PinholeCamera& camera,
                    TrackStatus status);
    bool UpdateReplay(const ViewerState& state);

    GlLines path_, truth_, outline_;
    GlLines walked_;  // with a replay: the path so far, over the whole one
    std::optional<std::size_t> walked_to_;
    std::uint64_t path_identity_ = 0;
    std::size_t path_done_ = 0, truth_done_ = 0;
    std::int64_t outline_frame_ = -1;
    Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
