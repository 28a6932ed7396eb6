// A scene: objects with classes and instances, and a common interface to their exact geometry and
// colour. Implemented by analytic bodies (analytic_scene.h) and textured triangle meshes
// (mesh_scene.h). Immutable once built: every const member is thread-safe.
//
// World frame: metres, right-handed, z up in the built-in scenes; a model keeps its own axes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "synth/texture.h"

namespace tessera {

// Result of a ray cast. `t` is in units of the ray's direction; for a ViewCaster this is the depth
// along the optical axis.
struct SurfaceHit {
    double t = std::numeric_limits<double>::infinity();
    std::int32_t part = -1;   // index of the shape or triangle; -1 = no hit
    std::int32_t chart = 0;   // analytic shapes: the chart that was hit (shape.h)
    float u = 0, v = 0;       // analytic shapes: chart coordinates, metres; meshes: barycentric
    float cos_incidence = 0;  // |cos| of the angle between ray and surface normal

    bool valid() const { return part >= 0; }
};

// One labelled object. Instance 0 and class 0 are the unlabelled surroundings.
struct SceneInstance {
    std::string name;  // "cup 1"
    int class_id = 0;  // index into Scene::class_names()
};

// Whether a surface moves. The values are the grey levels of the written masks.
enum class Mobility : std::uint8_t { kStatic = 0, kResting = 128, kMoving = 255 };

// A rectangle of pixels with exclusive ends.
struct PixelRect {
    int x_begin, y_begin, x_end, y_end;
    int width() const { return x_end - x_begin; }
    int height() const { return y_end - y_begin; }
};

// Casts the rays of one pinhole camera at one pose. Thread-safe.
class ViewCaster {
  public:
    virtual ~ViewCaster() = default;
    // Finds the nearest surface for each pixel of `rect`, row by row; `t` is the depth along the
    // optical axis in metres. The rays pass (offset_x, offset_y) pixels beside the pixel centres.
    // hits.size() must equal the area of the rect.
    virtual void Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
                      std::span<SurfaceHit> hits) const = 0;
};

class Scene {
  public:
    virtual ~Scene() = default;

    // The scene as it is `time_s` seconds after its start. The caster refers to the scene.
    virtual std::unique_ptr<ViewCaster> View(const PinholeCamera& camera,
                                             const Eigen::Isometry3d& T_world_camera,
                                             double time_s) const = 0;
    // Whether the surface at a hit is static, resting at this time or moving at this time.
    virtual Mobility MobilityOf(const SurfaceHit&, double /*time_s*/) const {
        return Mobility::kStatic;
    }
    virtual bool has_motion() const { return false; }
    // Returns the nearest static surface along a ray; `t` is in units of the direction's length.
    virtual SurfaceHit CastRay(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const = 0;
    // Outward unit normal at a hit.
    virtual Eigen::Vector3d Normal(const SurfaceHit& hit) const = 0;
    // Lit colour at a hit. `footprint_m`: extent of the sample on the surface, for filtering.
    virtual RgbF Colour(const SurfaceHit& hit, float footprint_m) const = 0;
    // Index into instances() at a hit.
    virtual int InstanceOf(const SurfaceHit& hit) const = 0;

    // The static surface is cut into patches of at most 0.1 m, to distinguish what a camera has
    // seen from the rest. PatchOf returns -1 for moving objects.
    virtual std::int64_t patch_count() const = 0;
    virtual std::int64_t PatchOf(const SurfaceHit& hit) const = 0;
    // Exact mesh of the patches (curved surfaces within 0.5 mm), without normals and colours.
    // `keep`: one flag per patch; only these are returned. A patch belongs to one instance.
    virtual TriangleMesh PatchMesh(const std::vector<bool>* keep = nullptr) const = 0;
    // The mesh of one instance. A moving one is placed as at the start.
    virtual TriangleMesh InstanceMesh(int instance) const = 0;

    // Distance from a world point to the nearest static surface, metres, negative inside a body.
    // Exact outside of bodies, and inside where bodies do not overlap. Empty for meshes, which need
    // not be closed.
    virtual std::optional<double> SignedDistance(const Eigen::Vector3d& p_world) const = 0;

    const std::vector<SceneInstance>& instances() const { return instances_; }
    const std::vector<std::string>& class_names() const { return class_names_; }
    // Axis-aligned bounds of all static parts, metres.
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  protected:
    std::vector<SceneInstance> instances_ = {{"surroundings", 0}};
    std::vector<std::string> class_names_ = {"unlabelled"};
    Eigen::AlignedBox3d bounds_;
};

}  // namespace tessera
