// A scene of boxes, spheres, cylinders and rectangles with textured surfaces and baked light. Add
// the parts, then call Finish; from then on it is const and thread-safe.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "synth/scene.h"
#include "synth/shape.h"

namespace tessera {

// Mapping of a texture onto a chart.
struct Paint {
    int texture = 0;  // from AddTexture
    // Size of the texture on the surface; 0: stretched over the chart.
    double width_m = 0;
    double height_m = 0;
    double offset_u_m = 0, offset_v_m = 0;
};

// A spherical light that emits equally in all directions.
struct Light {
    Eigen::Vector3d p_world;
    double radius_m = 0.2;   // for soft shadows
    double intensity = 1.0;  // irradiance at 1 m, as a fraction of full brightness
};

struct Lighting {
    std::vector<Light> lights;
    double ambient = 0.45;  // fraction of full brightness where nothing occludes
    double texel_m = 0.02;  // finest resolution of the baked light
    // False: constant light per face, from its orientation only (for scenes without texture).
    bool baked = true;
};

class AnalyticScene : public Scene {
  public:
    // Maps the pose at which a part was added to its pose t seconds after the start. Defined for
    // any t; thread-safe.
    using Motion = std::function<Eigen::Isometry3d(double time_s)>;

    int AddTexture(const ColourImage& image, Texture::Wrap wrap = Texture::Wrap::kRepeat);
    // Parts added from now on belong to this instance. New class names are registered as needed. An
    // empty one means the surroundings.
    void BeginInstance(const std::string& name, const std::string& class_name);
    // Parts added from now on move like this, until the next call. An empty motion makes them
    // static. Moving parts have constant light per face and cast no shadows.
    void BeginMotion(Motion motion);
    // Returns the part's number, for SetPaint. All charts get `paint`.
    int AddShape(const Shape& shape, const Paint& paint);
    void SetPaint(int part, int chart, const Paint& paint);
    // Bakes the light (deterministic) and completes the scene.
    void Finish(const Lighting& lighting);

    std::unique_ptr<ViewCaster> View(const PinholeCamera& camera,
                                     const Eigen::Isometry3d& T_world_camera,
                                     double time_s) const override;
    Mobility MobilityOf(const SurfaceHit& hit, double time_s) const override;
    bool has_motion() const override { return !motions_.empty(); }
    SurfaceHit CastRay(const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction) const override;
    Eigen::Vector3d Normal(const SurfaceHit& hit) const override;
    RgbF Colour(const SurfaceHit& hit, float footprint_m) const override;
    int InstanceOf(const SurfaceHit& hit) const override;
    std::int64_t patch_count() const override { return patch_count_; }
    std::int64_t PatchOf(const SurfaceHit& hit) const override;
    TriangleMesh PatchMesh(const std::vector<bool>* keep) const override;
    TriangleMesh InstanceMesh(int instance) const override;
    std::optional<double> SignedDistance(const Eigen::Vector3d& p_world) const override;

  private:
    friend class AnalyticView;

    // Paint, baked light (a grid of fractions of full brightness) and patch grid of a chart.
    struct Chart {
        Paint paint;
        // From metres to texture coordinates.
        float scale_u = 1, scale_v = 1, offset_u = 0, offset_v = 0;
        int light_columns = 1, light_rows = 1;
        float light_scale_u = 0, light_scale_v = 0;
        std::vector<float> light;
        int patch_columns = 1, patch_rows = 1;
        std::int64_t first_patch = 0;
    };
    struct Part {
        Shape shape;
        Eigen::Isometry3d T_shape_world;
        double radius_m = 0;  // of the bounding sphere
        int instance = 0;
        int motion = -1;  // index into motions_; -1: static
        std::array<Chart, 6> charts;
    };

    struct Occluders;
    Occluders FindOccluders(const Lighting& lighting, const Shape& shape, int chart) const;
    static double Irradiance(const Lighting& lighting, const Occluders& occluders,
                             const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                             std::uint64_t key);
    void BakeChart(const Lighting& lighting, std::size_t part, int chart);
    static void SetConstantLight(Part& part, int chart);
    float LightAt(const Chart& chart, float u, float v) const;
    void Tessellate(Part& part);
    static Eigen::Vector3d PatchCorner(const Shape& shape, int number, const Chart& chart,
                                       int column, int row);
    void AppendChart(const Shape& shape, int number, const Chart& chart,
                     const std::vector<bool>* keep, TriangleMesh& mesh) const;
    void AppendPatches(const Part& part, const std::vector<bool>* keep, TriangleMesh& mesh) const;

    std::vector<Texture> textures_;
    std::vector<Part> parts_;
    std::vector<Motion> motions_;
    int current_instance_ = 0, current_motion_ = -1;
    std::int64_t patch_count_ = 0;
};

}  // namespace tessera
