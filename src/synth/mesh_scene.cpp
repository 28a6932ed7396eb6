#include "synth/mesh_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/check.h"
#include "io/image_io.h"

namespace tessera {

struct MeshScene::Tracer {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    ~Tracer() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    void Build(const ObjModel& model) const;
};

namespace {

void SetRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, RTCRayHit& ray) {
    ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
    ray.ray.tnear = 0, ray.ray.tfar = std::numeric_limits<float>::infinity(), ray.ray.time = 0;
    ray.ray.mask = ~0u, ray.ray.id = 0, ray.ray.flags = 0;
    ray.hit.geomID = ray.hit.primID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

SurfaceHit HitOf(const RTCRayHit& ray) {
    SurfaceHit hit;
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.t = ray.ray.tfar;
    hit.part = static_cast<std::int32_t>(ray.hit.primID);
    hit.u = ray.hit.u;
    hit.v = ray.hit.v;
    const Eigen::Vector3f normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    const Eigen::Vector3f direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
    hit.cos_incidence = std::abs(normal.dot(direction)) / (normal.norm() * direction.norm());
    return hit;
}

// "Chair_01_002" -> "chair".
std::string ClassOf(const std::string& object) {
    const std::size_t end = object.find_last_not_of("_. 0123456789");
    std::string name = end == std::string::npos ? object : object.substr(0, end + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return name;
}

}  // namespace

void MeshScene::Tracer::Build(const ObjModel& model) const {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             3 * sizeof(float), model.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(unsigned), model.triangles.size());
    TESSERA_CHECK(vertices && indices, "Embree cannot allocate memory for {} triangles",
                  model.triangles.size());
    std::memcpy(vertices, model.vertices.data(), model.vertices.size() * 3 * sizeof(float));
    auto* index = static_cast<std::uint32_t*>(indices);
    for (const ObjModel::Triangle& triangle : model.triangles)
        index = std::copy(triangle.vertices.begin(), triangle.vertices.end(), index);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
}

class MeshView : public ViewCaster {
  public:
    MeshView(RTCScene scene, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera)
        : scene_(scene), camera_(camera), T_world_camera_(T_world_camera) {}

    void Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
              std::span<SurfaceHit> hits) const override {
        const Eigen::Vector3f origin = T_world_camera_.translation().cast<float>();
        std::vector<RTCRayHit> rays(hits.size());
        std::size_t i = 0;
        for (int y = rect.y_begin; y < rect.y_end; ++y) {
            for (int x = rect.x_begin; x < rect.x_end; ++x, ++i) {
                const Eigen::Vector3d d = camera_.Unproject(x + offset_x_px, y + offset_y_px, 1.0);
                SetRay(origin, (T_world_camera_.linear() * d).cast<float>(), rays[i]);
            }
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect1M(scene_, &context, rays.data(), static_cast<unsigned>(rays.size()),
                       sizeof(RTCRayHit));
        std::transform(rays.begin(), rays.end(), hits.begin(), HitOf);
    }

  private:
    RTCScene scene_;
    PinholeCamera camera_;
    Eigen::Isometry3d T_world_camera_;
};

MeshScene::MeshScene(ObjModel model)
    : model_(std::move(model)), tracer_(std::make_unique<Tracer>()) {
    for (const Eigen::Vector3f& p : model_.vertices) bounds_.extend(p.cast<double>());
    tracer_->Build(model_);
    ReadTextures();
    NameInstances();
    Tessellate();
    const Eigen::Vector3f sun = Eigen::Vector3f(0.35f, 0.5f, 0.8f).normalized();
    for (const ObjModel::Triangle& t : model_.triangles) {
        const Eigen::Vector3f a = model_.vertices[t.vertices[0]];
        const Eigen::Vector3f ab = model_.vertices[t.vertices[1]] - a,
                              ac = model_.vertices[t.vertices[2]] - a;
        const Eigen::Vector3f normal = ab.cross(ac);
        const Eigen::Vector2f uv_ab = t.uv[1] - t.uv[0], uv_ac = t.uv[2] - t.uv[0];
        const float uv_area = std::abs(uv_ab.x() * uv_ac.y() - uv_ab.y() * uv_ac.x());
        // Lights faces of either winding alike, because models are often inconsistent.
        const float facing = std::abs(normal.dot(sun)) / std::max(normal.norm(), 1e-12f);
        surfaces_.push_back(
            {0.68f + 0.32f * facing, std::sqrt(uv_area / std::max(normal.norm(), 1e-12f))});
    }
}

MeshScene::~MeshScene() = default;

void MeshScene::ReadTextures() {
    for (const ObjModel::Material& material : model_.materials) {
        ColourImage image(1, 1, material.colour);
        if (!material.texture_path.empty()) {
            if (Result<ColourImage> read = ReadColourImage(material.texture_path); read.ok())
                image = std::move(read.value());
            else
                missing_textures_.push_back(material.texture_path);
        }
        textures_.emplace_back(image, Texture::Wrap::kRepeat);
    }
}

void MeshScene::NameInstances() {
    for (const std::string& object : model_.object_names) {
        const std::string name = ClassOf(object);
        auto found = std::find(class_names_.begin() + 1, class_names_.end(), name);
        if (found == class_names_.end()) found = class_names_.insert(found, name);
        instances_.push_back({object, static_cast<int>(found - class_names_.begin())});
    }
}

std::unique_ptr<ViewCaster> MeshScene::View(const PinholeCamera& camera,
                                            const Eigen::Isometry3d& T_world_camera,
                                            double /*time_s*/) const {
    return std::make_unique<MeshView>(tracer_->scene, camera, T_world_camera);
}

SurfaceHit MeshScene::CastRay(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const {
    RTCRayHit ray;
    SetRay(origin.cast<float>(), direction.cast<float>(), ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tracer_->scene, &context, &ray);
    return HitOf(ray);
}

Eigen::Vector3d MeshScene::Normal(const SurfaceHit& hit) const {
    const auto& v = model_.triangles[hit.part].vertices;
    const Eigen::Vector3d a = model_.vertices[v[0]].cast<double>();
    return (model_.vertices[v[1]].cast<double>() - a)
        .cross(model_.vertices[v[2]].cast<double>() - a)
        .normalized();
}

RgbF MeshScene::Colour(const SurfaceHit& hit, float footprint_m) const {
    const ObjModel::Triangle& t = model_.triangles[hit.part];
    const Surface& surface = surfaces_[hit.part];
    const Eigen::Vector2f uv = (1 - hit.u - hit.v) * t.uv[0] + hit.u * t.uv[1] + hit.v * t.uv[2];
    const RgbF c = textures_[t.material].Sample(uv.x(), 1 - uv.y(), footprint_m * surface.uv_per_m);
    return {c.r * surface.shade, c.g * surface.shade, c.b * surface.shade};
}

int MeshScene::InstanceOf(const SurfaceHit& hit) const {
    return model_.triangles[hit.part].object + 1;
}

}  // namespace tessera
