#include "viz/scene_view.h"

#include <epoxy/gl.h>

#include "render/mesh_picture.h"
#include "render/projection.h"

namespace tessera {
namespace {

constexpr double kNearM = 0.05, kFarM = 500;

// The plane behind which the surface is hidden, (n, d): points with n^T p + d < 0; world frame,
// metres. `bounds`: of the surface; `up`: unit vector. nullopt: nothing is cut.
std::optional<Eigen::Vector4d> CutPlane(const ViewChoices& view, const Eigen::AlignedBox3d& bounds,
                                        const Eigen::Vector3d& up) {
    if (view.cut == Cut::kNone || bounds.isEmpty()) return std::nullopt;
    const Eigen::Vector3d towards = view.cut == Cut::kAbove ? up : view.cut_towards;
    const Eigen::Vector3d half = 0.5 * bounds.sizes();
    const double middle = towards.dot(bounds.center()), reach = towards.cwiseAbs().dot(half);
    constexpr double kBeyond = 1.05;  // so that the slider's ends are clearly outside
    const double at = middle + kBeyond * (2 * view.cut_at - 1) * reach;
    return Eigen::Vector4d(-towards.x(), -towards.y(), -towards.z(), at);
}

}  // namespace

Result<std::unique_ptr<SceneView>> SceneView::Create(bool is_software,
                                                     const CoverageLevels& levels) {
    Result<MeshProgram> mesh = MeshProgram::Create();
    if (!mesh.ok()) return mesh.status();
    Result<GlLineProgram> line = GlLineProgram::Create();
    if (!line.ok()) return line.status();
    return std::unique_ptr<SceneView>(
        new SceneView(std::move(mesh.value()), std::move(line.value()), is_software, levels));
}

void SceneView::SetModel(const ViewedModel& model) {
    const MeshView view = ChooseView(model.mesh, model.path);
    // ChooseView uses one of these two as up.
    const Eigen::Vector3d down = view.T_world_camera.linear().col(1);
    const Eigen::Vector3d up =
        -down.z() > down.y() ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, -1, 0);
    mesh_.SetModel(model, up);
    paths_.SetPath(model.path);
    camera_.SetUp(mesh_.Up().value_or(up));
    const Eigen::Vector3d eye = view.T_world_camera.translation(),
                          forward = view.T_world_camera.linear().col(2);
    const double ahead = std::max((mesh_.bounds().All().center() - eye).dot(forward), 0.1);
    camera_.Place(eye, eye + ahead * forward);
    changed_ = true;
}

bool SceneView::TakeMesh(ViewerLink& link, std::size_t most_bytes) {
    const bool any = mesh_.Take(link, most_bytes);
    changed_ |= any;
    if (any) StandUpright();
    return any;
}

// Ignores small changes, which would be visible as jitter.
void SceneView::StandUpright() {
    const auto found = mesh_.Up();
    if (found && found->dot(camera_.up()) < 0.9997) camera_.SetUp(*found);
}

bool SceneView::Follow(const ViewerState& state, double since_s) {
    if (!state.view.follow) {
        followed_ = false;
        return false;
    }
    const auto sensor = [&]() -> const Eigen::Isometry3d* {
        if (state.replay) return &state.replay->T_world_camera();
        const bool tracked = state.system.has_frame() && state.system.frame().report.tracked();
        return tracked ? &state.system.frame().report.track.T_world_camera : nullptr;
    }();
    if (!sensor) return false;
    const Eigen::Isometry3d& T_world_sensor = *sensor;
    const Eigen::Vector3d before = camera_.eye();
    const double step_s = followed_ ? since_s : -1;
    if (state.view.first_person)
        camera_.FollowInside(T_world_sensor, step_s);
    else
        camera_.Follow(T_world_sensor, step_s);
    followed_ = true;
    return (camera_.eye() - before).norm() > 1e-3;
}

void SceneView::ViewAll(const ViewerState& state) {
    camera_.ShowAll(mesh_.bounds().Around(state.system.place()));
}

bool SceneView::ChoicesChanged(const ViewerState& state, const Request& request) const {
    const ViewChoices &a = state.view, &b = drawn_.choices;
    return request.width != drawn_.request.width || request.height != drawn_.request.height ||
           request.smooth != drawn_.request.smooth || state.shading() != drawn_.shading ||
           a.wireframe != b.wireframe || a.depth_test != b.depth_test ||
           a.show_truth != b.show_truth || a.show_objects != b.show_objects || a.cut != b.cut ||
           a.cut_at != b.cut_at || a.cut_towards != b.cut_towards;
}

bool SceneView::Draw(const ViewerState& state, const Request& request) {
    changed_ |= paths_.Update(state);
    changed_ |= boxes_.Update(state);
    changed_ |= measurements_.Update(state);
    const bool moved = !camera_.T_world_camera().isApprox(drawn_.T_world_view, 1e-7);
    const bool at_once = request.may_redraw || (moved && request.by_hand);
    if (!ChoicesChanged(state, request) && !((moved || changed_) && at_once)) return false;
    changed_ = false;
    drawn_ = {camera_.T_world_camera(), state.view, state.shading(), request};
    const PinholeCamera pinhole = ViewCamera::Camera(request.width, request.height);
    target_.Begin(request.width, request.height, request.smooth || !is_software_ ? 4 : 1);
    if (state.view.depth_test) glEnable(GL_DEPTH_TEST);
    DrawMesh(state, pinhole);
    DrawPaths(state, pinhole);
    if (!state.view.depth_test) DrawDepth(state, pinhole);
    target_.End();
    return true;
}

// Only the depth, for clicks on a surface that one sees through.
void SceneView::DrawDepth(const ViewerState& state, const PinholeCamera& pinhole) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    DrawMesh(state, pinhole);
    glDisable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void SceneView::DrawMesh(const ViewerState& state, const PinholeCamera& pinhole) {
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CW);  // see ClipFromCamera
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    if (state.view.wireframe) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    const Eigen::Isometry3d& T_world_view = drawn_.T_world_view;
    const Eigen::Matrix4d clip = ClipFromCamera(pinhole, kNearM, kFarM);
    const std::optional<Eigen::Vector4d> cut =
        CutPlane(state.view, mesh_.bounds().Around(state.system.place()), camera_.up());
    MeshProgram::Look look{drawn_.shading, levels_};
    if (cut) {
        // A plane is a row vector: points go by a matrix, planes by its inverse.
        const Eigen::Matrix4d clip_from_world = clip * T_world_view.inverse().matrix();
        look.cut_in_clip_space = clip_from_world.inverse().transpose() * *cut;
        glEnable(GL_CLIP_DISTANCE0);
    }
    program_.Use(pinhole, T_world_view, camera_.up(), look);
    mesh_.Draw(clip, T_world_view, program_.clip_from_position());
    glDisable(GL_CLIP_DISTANCE0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CULL_FACE);
}

// Draws the lines twice: faintly where surfaces hide them, then fully where they are visible.
void SceneView::DrawPaths(const ViewerState& state, const PinholeCamera& pinhole) {
    GlLineProgram::View view;
    view.clip_from_world =
        ClipFromCamera(pinhole, kNearM, kFarM) * drawn_.T_world_view.inverse().matrix();
    view.width_px = pinhole.width;
    view.height_px = pinhole.height;
    // Towards the eye, into the same pixels: lines that lie on a surface are not hidden by it.
    constexpr double kNearer = 0.995;
    GlLineProgram::View before_surface = view;
    before_surface.clip_from_world = ClipFromCamera(pinhole, kNearM, kFarM) *
                                     Eigen::Vector4d(kNearer, kNearer, kNearer, 1).asDiagonal() *
                                     drawn_.T_world_view.inverse().matrix();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    for (const bool hidden : {true, false}) {
        glDepthFunc(hidden ? GL_GREATER : GL_LEQUAL);
        paths_.Draw(lines_, view, state.view.show_truth, hidden ? 0.22f : 1.0f);
        if (state.view.show_objects) boxes_.Draw(lines_, view, hidden ? 0.3f : 1.0f);
        measurements_.Draw(lines_, before_surface, hidden ? 0.4f : 1.0f);
    }
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
}

std::optional<Eigen::Vector3d> SceneView::PointAt(int x, int y) const {
    const double buffer = target_.DepthAt(x, y);
    if (buffer >= 1) return std::nullopt;
    const PinholeCamera pinhole = ViewCamera::Camera(drawn_.request.width, drawn_.request.height);
    return drawn_.T_world_view * pinhole.Unproject(x, y, DepthFromBuffer(buffer, kNearM, kFarM));
}

std::optional<Eigen::Vector3d> SceneView::PixelOf(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d p = drawn_.T_world_view.inverse() * p_world;
    if (p.z() < kNearM) return std::nullopt;
    const Eigen::Vector2d pixel =
        ViewCamera::Camera(drawn_.request.width, drawn_.request.height).Project(p);
    return Eigen::Vector3d(pixel.x(), pixel.y(), p.z());
}

}  // namespace tessera
