#include "render/mesh_rasteriser.h"

#include <epoxy/gl.h>

#include <optional>
#include <utility>

#include "core/stopwatch.h"
#include "mapping/mesher.h"
#include "render/geometry_builder.h"
#include "render/gl_context.h"
#include "render/gl_mesh_store.h"
#include "render/gl_program.h"
#include "render/gl_view_target.h"
#include "render/projection.h"

namespace tessera {
namespace {

// Both sources follow this, and with labels a line that defines LABELS.
constexpr const char* kVersion = "#version 330 core\n";
constexpr const char* kVertexSource = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal;
layout(location = 2) in vec4 colour;
uniform mat4 clip_from_position;
uniform mat3 camera_from_world;
out vec3 normal_camera;
out vec4 weighted_colour;
#ifdef LABELS
layout(location = 3) in vec4 mark;
flat out uint vertex_label;
#endif

void main() {
    gl_Position = clip_from_position * vec4(position, 1);
    vec2 e = normal / 32767;
    vec3 n = vec3(e, 1 - abs(e.x) - abs(e.y));
    if (n.z < 0) n.xy = (1 - abs(e.yx)) * vec2(e.x < 0 ? -1 : 1, e.y < 0 ? -1 : 1);
    normal_camera = camera_from_world * normalize(n);
    weighted_colour = vec4(colour.rgb * colour.a, colour.a);
#ifdef LABELS
    vertex_label = uint(mark.r * 255 + 0.5) + 256u * uint(mark.g * 255 + 0.5);
#endif
}
)";

// Weights colours by the surrounding vertices that have one, as RayCaster does with voxels.
constexpr const char* kFragmentSource = R"(
in vec3 normal_camera;
in vec4 weighted_colour;
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 colour;
#ifdef LABELS
flat in uint vertex_label;
layout(location = 2) out uint label;
#endif

void main() {
    vec3 n = normal_camera / max(length(normal_camera), 1e-6);
    bool has_colour = weighted_colour.a > 1e-3;
    vec3 rgb = has_colour ? weighted_colour.rgb / weighted_colour.a : vec3(128.0 / 255.0);
    surface = vec4(n, has_colour ? dot(rgb, vec3(0.299, 0.587, 0.114)) : -1.0);
    colour = vec4(rgb, 1);
#ifdef LABELS
    label = vertex_label;
#endif
}
)";

}  // namespace

// Members are destroyed from the bottom up: the context is the last one, and current until then.
struct MeshRasteriser::Impl {
    Impl(const MeshConfig& config, LabelVertex label, std::unique_ptr<GlContext> gl)
        : context(std::move(gl)), mesher(config), label_vertex(std::move(label)) {}
    ~Impl() {
        const auto scope = context->MakeCurrent();
        target.reset();
        store.reset();
        program.reset();
    }
    Status Initialise();
    void TakeOver(const BlockMap& map);
    void Draw(const PredictedView& view, float min_depth_m, float max_depth_m);

    std::unique_ptr<GlContext> context;
    Mesher mesher;
    const LabelVertex label_vertex;  // empty without labels
    GeometryBuilder builder;
    std::uint64_t map_identity = 0;
    std::optional<GlProgram> program;
    int clip_from_position = -1, camera_from_world = -1;
    std::optional<GlMeshStore> store;
    std::optional<GlViewTarget> target;
    Image<std::uint16_t> labels;
    Status status;
    Timings timings;
};

Status MeshRasteriser::Impl::Initialise() {
    const auto scope = context->MakeCurrent();
    const bool labelled = label_vertex != nullptr;
    const std::string start = std::string(kVersion) + (labelled ? "#define LABELS\n" : "");
    Result<GlProgram> made =
        GlProgram::Create((start + kVertexSource).c_str(), (start + kFragmentSource).c_str());
    if (!made.ok())
        return Status::Error(fmt::format("{}: {}", context->renderer(), made.message()));
    program.emplace(std::move(made.value()));
    clip_from_position = program->Location("clip_from_position");
    camera_from_world = program->Location("camera_from_world");
    store.emplace();
    target.emplace(labelled);
    return Status::Ok();
}

// Brings mesh and store up to date.
void MeshRasteriser::Impl::TakeOver(const BlockMap& map) {
    if (map.identity() != map_identity) {
        mesher.Clear();
        builder.Clear();
        store->Clear();
        map_identity = map.identity();
    }
    Stopwatch watch;
    mesher.Update(map);
    timings.mesh_ms += watch.LapMs();
    MarkVertex mark;
    if (label_vertex)
        mark = [&](const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
            return VertexMark::OfLabel(label_vertex(map, owner, vertex));
        };
    store->Replace(map.config().voxel_size_m, builder.Build(map, mesher, mark));
    timings.upload_ms += watch.LapMs();
}

void MeshRasteriser::Impl::Draw(const PredictedView& view, float min_depth_m, float max_depth_m) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CW);  // see ClipFromCamera
    program->Use();
    const Eigen::Matrix3f rotation = view.T_world_camera.linear().transpose().cast<float>();
    glUniformMatrix3fv(camera_from_world, 1, GL_FALSE, rotation.data());
    store->Draw(ClipFromCamera(view.camera, min_depth_m, max_depth_m), view.T_world_camera,
                clip_from_position);
}

Result<std::unique_ptr<MeshRasteriser>> MeshRasteriser::Create(const MeshConfig& config,
                                                               LabelVertex label) {
    Result<std::unique_ptr<GlContext>> context = GlContext::Create();
    if (!context.ok()) return context.status();
    auto impl = std::make_unique<Impl>(config, std::move(label), std::move(context.value()));
    if (const Status status = impl->Initialise(); !status.ok()) return status;
    return std::unique_ptr<MeshRasteriser>(new MeshRasteriser(std::move(impl)));
}

MeshRasteriser::MeshRasteriser(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MeshRasteriser::~MeshRasteriser() = default;

void MeshRasteriser::Predict(const BlockMap& map, const PinholeCamera& camera,
                             const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                             float max_depth_m, PredictedView& view) {
    TESSERA_CHECK(min_depth_m > 0 && max_depth_m > min_depth_m, "{} m to {} m", min_depth_m,
                  max_depth_m);
    view.Resize(camera, T_world_camera);
    const auto scope = impl_->context->MakeCurrent();
    impl_->TakeOver(map);
    impl_->status = impl_->target->Begin(camera.width, camera.height);
    if (!impl_->status.ok()) {
        view.SetNothing();
        impl_->labels.Resize(0, 0);
        return;
    }
    Stopwatch watch;
    impl_->Draw(view, min_depth_m, max_depth_m);
    impl_->timings.draw_ms += watch.LapMs();
    impl_->target->ReadBack(min_depth_m, max_depth_m, view);
    if (impl_->label_vertex) impl_->target->ReadLabels(impl_->labels);
    impl_->timings.read_back_ms += watch.LapMs();
}

const Status& MeshRasteriser::status() const { return impl_->status; }
const Image<std::uint16_t>& MeshRasteriser::labels() const { return impl_->labels; }
void MeshRasteriser::LabelAgain(std::span<const BlockId> blocks) {
    impl_->builder.MarkAgain(blocks);
}
MeshRasteriser::Timings MeshRasteriser::TakeTimings() {
    return std::exchange(impl_->timings, Timings());
}
std::string MeshRasteriser::renderer() const { return impl_->context->renderer(); }
std::size_t MeshRasteriser::bytes() const { return impl_->mesher.bytes() + impl_->store->bytes(); }

}  // namespace tessera
