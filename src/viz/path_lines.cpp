#include "viz/path_lines.h"

#include "viz/theme.h"

namespace tessera {
namespace {

using Colour = std::array<std::uint8_t, 4>;
constexpr Colour kNone{}, kTruth{235, 235, 235, 170}, kPath{84, 160, 255, 255};

Colour ToColour(ImU32 packed) {
    const auto byte = [packed](int shift) { return static_cast<std::uint8_t>(packed >> shift); };
    return {byte(IM_COL32_R_SHIFT), byte(IM_COL32_G_SHIFT), byte(IM_COL32_B_SHIFT), 255};
}

LineVertex Vertex(const Eigen::Vector3f& p, const Colour& colour) {
    return {{p.x(), p.y(), p.z()}, colour};
}

// Appends the points after the first `done` ones. Where a segment begins, appends a transparent
// vertex first, so that no line leads to it.
void AppendNew(const std::vector<SystemView::PathPoint>& points, std::size_t done,
               const Colour& good, GlLines& lines) {
    std::vector<LineVertex> vertices;
    for (std::size_t i = done; i < points.size(); ++i) {
        const SystemView::PathPoint& point = points[i];
        if (!point.follows) vertices.push_back(Vertex(point.position_m, kNone));
        const bool is_good = point.status == TrackStatus::kGood;
        vertices.push_back(Vertex(point.position_m, is_good ? good : ToColour(palette::kWarning)));
    }
    if (!vertices.empty()) lines.Append(vertices);
}

}  // namespace

void PathLines::SetPath(const std::vector<Eigen::Isometry3d>& path) {
    std::vector<LineVertex> vertices;
    for (const Eigen::Isometry3d& T : path)
        vertices.push_back(Vertex(T.translation().cast<float>(), kPath));
    path_.Clear();
    if (!vertices.empty()) path_.Append(vertices);
}

bool PathLines::UpdateReplay(const ViewerState& state) {
    const Replay& replay = *state.replay;
    if (walked_to_ == replay.position()) return false;
    walked_to_ = replay.position();
    std::vector<LineVertex> vertices;
    bool follows = false;
    for (std::size_t i = 0; i <= replay.position(); ++i) {
        const TimeLineFrame& frame = replay.line().frames[i];
        if (frame.T_world_camera) {
            const Eigen::Vector3f at = frame.T_world_camera->translation().cast<float>();
            if (!follows) vertices.push_back(Vertex(at, kNone));
            vertices.push_back(Vertex(at, kPath));
        }
        follows = frame.T_world_camera.has_value();
    }
    walked_.Clear();
    if (!vertices.empty()) walked_.Append(vertices);
    const FrameState frame_state = replay.frame().row.state;
    SetOutline(replay.T_world_camera(), state.options.camera,
               frame_state == FrameState::kFused     ? TrackStatus::kGood
               : frame_state == FrameState::kTracked ? TrackStatus::kPoor
                                                     : TrackStatus::kLost);
    return true;
}

bool PathLines::Update(const ViewerState& state) {
    if (state.replay) return UpdateReplay(state);
    const SystemView& system = state.system;
    if (!system.has_frame()) return false;
    if (path_identity_ != system.path_identity()) {
        path_identity_ = system.path_identity();
        path_.Clear();
        truth_.Clear();
        path_done_ = truth_done_ = 0;
    }
    const bool changed = system.path().size() != path_done_ ||
                         system.truth().size() != truth_done_ ||
                         system.frame().report.index != outline_frame_;
    AppendNew(system.path(), path_done_, kPath, path_);
    AppendNew(system.truth(), truth_done_, kTruth, truth_);
    path_done_ = system.path().size();
    truth_done_ = system.truth().size();
    const FrameReport& report = system.frame().report;
    if (report.index != outline_frame_) {
        outline_frame_ = report.index;
        if (report.tracked()) T_world_sensor_ = report.track.T_world_camera;
        SetOutline(T_world_sensor_, state.options.camera, report.track.status);
    }
    return changed;
}

// Draws the sensor as a pyramid 15 cm deep, with a mark on its top side.
void PathLines::SetOutline(const Eigen::Isometry3d& T_world_camera, const PinholeCamera& camera,
                           TrackStatus status) {
    constexpr double kDepthM = 0.15;
    const Colour colour = ToColour(status == TrackStatus::kGood   ? palette::kGood
                                   : status == TrackStatus::kPoor ? palette::kWarning
                                                                  : palette::kBad);
    const auto corner = [&](double u, double v) {
        return Eigen::Vector3f((T_world_camera * camera.Unproject(u, v, kDepthM)).cast<float>());
    };
    const double right = camera.width, bottom = camera.height;
    const Eigen::Vector3f apex = T_world_camera.translation().cast<float>();
    const std::array<Eigen::Vector3f, 4> corners{corner(0, 0), corner(right, 0),
                                                 corner(right, bottom), corner(0, bottom)};
    std::vector<LineVertex> vertices;
    const auto line = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
        vertices.push_back(Vertex(a, colour));
        vertices.push_back(Vertex(b, colour));
    };
    for (std::size_t i = 0; i < 4; ++i) {
        line(apex, corners[i]);
        line(corners[i], corners[(i + 1) % 4]);
    }
    const Eigen::Vector3f tip = corner(0.5 * right, -0.22 * bottom);
    line(corner(0.3 * right, 0), tip);
    line(tip, corner(0.7 * right, 0));
    outline_.Clear();
    outline_.Append(vertices);
}

void PathLines::Draw(const GlLineProgram& program, const GlLineProgram::View& view, bool with_truth,
                     float opacity) {
    if (with_truth) program.Draw(truth_, view, true, Scaled(1.5f), opacity);
    constexpr float kAhead = 0.5f;  // of a replay: where the camera has not been yet
    program.Draw(path_, view, true, Scaled(walked_to_ ? 1.5f : 2.2f),
                 walked_to_ ? kAhead * opacity : opacity);
    program.Draw(walked_, view, true, Scaled(2.6f), opacity);
    program.Draw(outline_, view, false, Scaled(2), opacity);
}

}  // namespace tessera
