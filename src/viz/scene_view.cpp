#include "viz/scene_view.h"

#include <epoxy/gl.h>

#include "render/mesh_picture.h"
#include "render/projection.h"
#include "viz/cut_plane.h"
#include "viz/gl_lines.h"
#include "viz/measure_lines.h"
#include "viz/mesh_program.h"
#include "viz/object_boxes.h"
#include "viz/path_lines.h"
#include "viz/scene_mesh.h"
#include "viz/scene_target.h"

namespace tessera {
namespace {

constexpr double kNearM = 0.05, kFarM = 500;

}  // namespace

struct SceneView::Impl {
    Impl(MeshProgram mesh_program, GlLineProgram line_program, bool software,
         const CoverageLevels& coverage_levels)
        : is_software(software),
          program(std::move(mesh_program)),
          lines(std::move(line_program)),
          levels(coverage_levels),
          mesh(coverage_levels) {}

    struct Drawn {
        Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
        ViewChoices choices;
        Shading shading = Shading::kColour;
        Request request;
    };
    void StandUpright();
    bool ChoicesChanged(const ViewerState& state, const Request& request) const;
    void DrawMesh(const ViewerState& state, const PinholeCamera& pinhole);
    void DrawDepth(const ViewerState& state, const PinholeCamera& pinhole);
    void DrawPaths(const ViewerState& state, const PinholeCamera& pinhole);

    bool is_software;
    MeshProgram program;
    GlLineProgram lines;
    const CoverageLevels levels;
    SceneMesh mesh;
    PathLines paths;
    ObjectBoxes boxes;
    MeasureLines measurements;
    SceneTarget target;
    ViewCamera camera;
    bool followed = false, changed = true;
    Drawn drawn;
};

Result<std::unique_ptr<SceneView>> SceneView::Create(bool is_software,
                                                     const CoverageLevels& levels) {
    Result<MeshProgram> mesh = MeshProgram::Create();
    if (!mesh.ok()) return mesh.status();
    Result<GlLineProgram> line = GlLineProgram::Create();
    if (!line.ok()) return line.status();
    return std::unique_ptr<SceneView>(new SceneView(std::make_unique<Impl>(
        std::move(mesh.value()), std::move(line.value()), is_software, levels)));
}

SceneView::SceneView(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneView::~SceneView() = default;

const Coverage& SceneView::coverage() const { return impl_->mesh.coverage(); }
ViewCamera& SceneView::camera() { return impl_->camera; }
unsigned SceneView::texture() const { return impl_->target.texture(); }
std::size_t SceneView::triangles() const { return impl_->mesh.triangles(); }
bool SceneView::has_final_mesh() const { return impl_->mesh.is_final(); }

void SceneView::SetModel(const ViewedModel& model) {
    const MeshView view = ChooseView(model.mesh, model.path);
    // ChooseView uses one of these two as up.
    const Eigen::Vector3d down = view.T_world_camera.linear().col(1);
    const Eigen::Vector3d up =
        -down.z() > down.y() ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, -1, 0);
    impl_->mesh.SetModel(model, up);
    impl_->paths.SetPath(model.path);
    impl_->camera.SetUp(impl_->mesh.Up().value_or(up));
    const Eigen::Vector3d eye = view.T_world_camera.translation(),
                          forward = view.T_world_camera.linear().col(2);
    const double ahead = std::max((impl_->mesh.bounds().All().center() - eye).dot(forward), 0.1);
    impl_->camera.Place(eye, eye + ahead * forward);
    impl_->changed = true;
}

bool SceneView::TakeMesh(ViewerLink& link, std::size_t most_bytes) {
    const bool any = impl_->mesh.Take(link, most_bytes);
    impl_->changed |= any;
    if (any) impl_->StandUpright();
    return any;
}

// Ignores small changes, which would be visible as jitter.
void SceneView::Impl::StandUpright() {
    const auto found = mesh.Up();
    if (found && found->dot(camera.up()) < 0.9997) camera.SetUp(*found);
}

bool SceneView::Follow(const ViewerState& state, double since_s) {
    if (!state.view.follow) {
        impl_->followed = false;
        return false;
    }
    const auto sensor = [&]() -> const Eigen::Isometry3d* {
        if (state.replay) return &state.replay->T_world_camera();
        const bool tracked = state.system.has_frame() && state.system.frame().report.tracked();
        return tracked ? &state.system.frame().report.track.T_world_camera : nullptr;
    }();
    if (!sensor) return false;
    const Eigen::Isometry3d& T_world_sensor = *sensor;
    const Eigen::Vector3d before = impl_->camera.eye();
    const double step_s = impl_->followed ? since_s : -1;
    if (state.view.first_person)
        impl_->camera.FollowInside(T_world_sensor, step_s);
    else
        impl_->camera.Follow(T_world_sensor, step_s);
    impl_->followed = true;
    return (impl_->camera.eye() - before).norm() > 1e-3;
}

void SceneView::ViewAll(const ViewerState& state) {
    impl_->camera.ShowAll(impl_->mesh.bounds().Around(state.system.place()));
}

bool SceneView::Impl::ChoicesChanged(const ViewerState& state, const Request& request) const {
    const ViewChoices &a = state.view, &b = drawn.choices;
    return request.width != drawn.request.width || request.height != drawn.request.height ||
           request.smooth != drawn.request.smooth || state.shading() != drawn.shading ||
           a.wireframe != b.wireframe || a.depth_test != b.depth_test ||
           a.show_truth != b.show_truth || a.show_objects != b.show_objects || a.cut != b.cut ||
           a.cut_at != b.cut_at || a.cut_towards != b.cut_towards;
}

bool SceneView::Draw(const ViewerState& state, const Request& request) {
    Impl& s = *impl_;
    s.changed |= s.paths.Update(state);
    s.changed |= s.boxes.Update(state);
    s.changed |= s.measurements.Update(state);
    const bool moved = !s.camera.T_world_camera().isApprox(s.drawn.T_world_view, 1e-7);
    const bool at_once = request.may_redraw || (moved && request.by_hand);
    if (!s.ChoicesChanged(state, request) && !((moved || s.changed) && at_once)) return false;
    s.changed = false;
    s.drawn = {s.camera.T_world_camera(), state.view, state.shading(), request};
    const PinholeCamera pinhole = ViewCamera::Camera(request.width, request.height);
    s.target.Begin(request.width, request.height, request.smooth || !s.is_software ? 4 : 1);
    if (state.view.depth_test) glEnable(GL_DEPTH_TEST);
    s.DrawMesh(state, pinhole);
    s.DrawPaths(state, pinhole);
    if (!state.view.depth_test) s.DrawDepth(state, pinhole);
    s.target.End();
    return true;
}

// Only the depth, for clicks on a surface that one sees through.
void SceneView::Impl::DrawDepth(const ViewerState& state, const PinholeCamera& pinhole) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    DrawMesh(state, pinhole);
    glDisable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void SceneView::Impl::DrawMesh(const ViewerState& state, const PinholeCamera& pinhole) {
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CW);  // see ClipFromCamera
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    if (state.view.wireframe) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    const Eigen::Isometry3d& T_world_view = drawn.T_world_view;
    const Eigen::Matrix4d clip = ClipFromCamera(pinhole, kNearM, kFarM);
    const std::optional<Eigen::Vector4d> cut =
        CutPlane(state.view, mesh.bounds().Around(state.system.place()), camera.up());
    MeshProgram::Look look{drawn.shading, levels};
    if (cut) {
        // A plane is a row vector: points go by a matrix, planes by its inverse.
        const Eigen::Matrix4d clip_from_world = clip * T_world_view.inverse().matrix();
        look.cut_in_clip_space = clip_from_world.inverse().transpose() * *cut;
        glEnable(GL_CLIP_DISTANCE0);
    }
    program.Use(pinhole, T_world_view, camera.up(), look);
    mesh.Draw(clip, T_world_view, program.clip_from_position());
    glDisable(GL_CLIP_DISTANCE0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CULL_FACE);
}

// Draws the lines twice: faintly where surfaces hide them, then fully where they are visible.
void SceneView::Impl::DrawPaths(const ViewerState& state, const PinholeCamera& pinhole) {
    GlLineProgram::View view;
    view.clip_from_world =
        ClipFromCamera(pinhole, kNearM, kFarM) * drawn.T_world_view.inverse().matrix();
    view.width_px = pinhole.width;
    view.height_px = pinhole.height;
    // Towards the eye, into the same pixels: lines that lie on a surface are not hidden by it.
    constexpr double kNearer = 0.995;
    GlLineProgram::View before_surface = view;
    before_surface.clip_from_world = ClipFromCamera(pinhole, kNearM, kFarM) *
                                     Eigen::Vector4d(kNearer, kNearer, kNearer, 1).asDiagonal() *
                                     drawn.T_world_view.inverse().matrix();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    for (const bool hidden : {true, false}) {
        glDepthFunc(hidden ? GL_GREATER : GL_LEQUAL);
        paths.Draw(lines, view, state.view.show_truth, hidden ? 0.22f : 1.0f);
        if (state.view.show_objects) boxes.Draw(lines, view, hidden ? 0.3f : 1.0f);
        measurements.Draw(lines, before_surface, hidden ? 0.4f : 1.0f);
    }
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
}

std::optional<Eigen::Vector3d> SceneView::PointAt(int x, int y) const {
    const double buffer = impl_->target.DepthAt(x, y);
    if (buffer >= 1) return std::nullopt;
    const PinholeCamera pinhole =
        ViewCamera::Camera(impl_->drawn.request.width, impl_->drawn.request.height);
    return impl_->drawn.T_world_view *
           pinhole.Unproject(x, y, DepthFromBuffer(buffer, kNearM, kFarM));
}

std::optional<Eigen::Vector3d> SceneView::PixelOf(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d p = impl_->drawn.T_world_view.inverse() * p_world;
    if (p.z() < kNearM) return std::nullopt;
    const Eigen::Vector2d pixel =
        ViewCamera::Camera(impl_->drawn.request.width, impl_->drawn.request.height).Project(p);
    return Eigen::Vector3d(pixel.x(), pixel.y(), p.z());
}

}  // namespace tessera
