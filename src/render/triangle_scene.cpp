#include "render/triangle_scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "render/closest_point.h"

namespace tessera {
namespace {

// Lets rays pass through triangles that face away from them.
void RejectBackFaces(const RTCFilterFunctionNArguments* args) {
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const unsigned n = args->N;
        const float along = RTCRayN_dir_x(args->ray, n, i) * RTCHitN_Ng_x(args->hit, n, i) +
                            RTCRayN_dir_y(args->ray, n, i) * RTCHitN_Ng_y(args->hit, n, i) +
                            RTCRayN_dir_z(args->ray, n, i) * RTCHitN_Ng_z(args->hit, n, i);
        if (along > 0) args->valid[i] = 0;
    }
}

using Corners = std::array<std::uint32_t, 3>;

struct NearestQuery {
    const Eigen::Vector3f* vertices;
    const Corners* triangles;
    Eigen::Vector3d point;
    double best2;  // squared distance, m^2
    SurfacePoint result;

    // A little more than the true radius, because the tree is searched in float.
    float SearchRadius() const {
        const double rounding_m = 1e-6 * (1 + point.cwiseAbs().maxCoeff());
        return static_cast<float>(std::sqrt(best2) * (1 + 1e-5) + rounding_m);
    }
};

bool MeetTriangle(RTCPointQueryFunctionArguments* args) {
    auto& query = *static_cast<NearestQuery*>(args->userPtr);
    const Corners& corners = query.triangles[args->primID];
    const Eigen::Vector3d a = query.vertices[corners[0]].cast<double>();
    const Eigen::Vector3d b = query.vertices[corners[1]].cast<double>();
    const Eigen::Vector3d c = query.vertices[corners[2]].cast<double>();
    const Eigen::Vector3d q = ClosestOnTriangle(query.point, a, b, c);
    const double distance2 = (q - query.point).squaredNorm();
    // Take the first of equally near triangles, so that the result is independent of visiting
    // order.
    const bool first = distance2 == query.best2 && args->primID < query.result.triangle;
    if (!(distance2 < query.best2) && !first) return false;
    query.best2 = distance2;
    query.result = {args->primID, std::sqrt(distance2)};
    args->query->radius = query.SearchRadius();
    return true;
}

}  // namespace

struct TriangleScene::Scene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const Eigen::Vector3f* vertices = nullptr;  // in Embree's buffers
    const Corners* triangles = nullptr;

    void Attach(const TriangleMesh& mesh);
    ~Scene() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

TriangleScene::TriangleScene(const TriangleMesh& mesh) : scene_(std::make_unique<Scene>()) {
    scene_->device = rtcNewDevice(nullptr);
    TESSERA_CHECK(scene_->device, "Embree: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
    scene_->scene = rtcNewScene(scene_->device);
    // The compact flag halves the memory and is no slower.
    rtcSetSceneFlags(scene_->scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT |
                                                RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    if (!mesh.triangles.empty()) scene_->Attach(mesh);
    rtcCommitScene(scene_->scene);
    const RTCError error = rtcGetDeviceError(scene_->device);
    TESSERA_CHECK(error == RTC_ERROR_NONE, "Embree: error {}", static_cast<int>(error));
}

void TriangleScene::Scene::Attach(const TriangleMesh& mesh) {
    const std::size_t vertex_count = mesh.vertices.size(), count = mesh.triangles.size();
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* own_vertices = static_cast<Eigen::Vector3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Eigen::Vector3f), vertex_count));
    auto* own_triangles = static_cast<Corners*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Corners), count));
    TESSERA_CHECK(own_vertices && own_triangles, "Embree: no memory for {} triangles", count);
    std::copy(mesh.vertices.begin(), mesh.vertices.end(), own_vertices);
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), own_triangles);
    vertices = own_vertices;
    triangles = own_triangles;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

TriangleScene::~TriangleScene() = default;
TriangleScene::TriangleScene(TriangleScene&&) noexcept = default;
TriangleScene& TriangleScene::operator=(TriangleScene&&) noexcept = default;

std::array<RayHit, 4> TriangleScene::CastFour(const Eigen::Vector3f& origin,
                                              const std::array<Eigen::Vector3f, 4>& directions,
                                              bool cull_back_faces) const {
    RTCRayHit4 packet;
    for (unsigned i = 0; i < 4; ++i) {
        packet.ray.org_x[i] = origin.x();
        packet.ray.org_y[i] = origin.y();
        packet.ray.org_z[i] = origin.z();
        packet.ray.dir_x[i] = directions[i].x();
        packet.ray.dir_y[i] = directions[i].y();
        packet.ray.dir_z[i] = directions[i].z();
        packet.ray.tnear[i] = 0;
        packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
        packet.ray.time[i] = 0;
        packet.ray.mask[i] = ~0u;
        packet.ray.id[i] = i;
        packet.ray.flags[i] = 0;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if (cull_back_faces) context.filter = &RejectBackFaces;
    alignas(16) const int valid[4] = {-1, -1, -1, -1};
    rtcIntersect4(valid, scene_->scene, &context, &packet);
    std::array<RayHit, 4> hits;
    for (unsigned i = 0; i < 4; ++i)
        if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
            hits[i] = {packet.hit.primID[i], packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i]};
    return hits;
}

SurfacePoint TriangleScene::Nearest(const Eigen::Vector3d& point, double max_distance_m) const {
    NearestQuery search{
        scene_->vertices, scene_->triangles, point, max_distance_m * max_distance_m, {}};
    RTCPointQuery query;
    query.x = static_cast<float>(point.x());
    query.y = static_cast<float>(point.y());
    query.z = static_cast<float>(point.z());
    query.time = 0;
    query.radius = search.SearchRadius();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_->scene, &query, &context, &MeetTriangle, &search);
    return search.result;
}

}  // namespace tessera
