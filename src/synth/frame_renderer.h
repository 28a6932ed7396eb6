// Ideal pictures of a scene: what a perfect camera would see, with all truth. The sensor model
// (sensor_model.h) makes measurements of them.
#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

// Images of one size. Where no surface is seen: depth 0, instance and class 0, patch -1, colour
// black.
struct RenderedView {
    Image<RgbF> colour;          // grey levels [0, 255], averaged over the pixel and the exposure
    DepthImage depth_m;          // exact, through the pixel's centre, at mid-exposure
    Image<float> cos_incidence;  // |cos| between ray and normal
    Image<std::uint16_t> class_id;
    Image<std::uint16_t> instance;
    Image<Mobility> mobility;    // of the surface at that time
    Image<std::int64_t> patch;  // Scene::PatchOf; empty unless asked for
};

class FrameRenderer {
  public:
    // Refers to the scene.
    FrameRenderer(const Scene& scene, const PinholeCamera& camera)
        : scene_(scene), camera_(camera) {}

    // The view at `time_s`, the middle of an exposure of `exposure_s` seconds (0: no motion blur).
    // Four rays a pixel sample the pixel's area and the exposure at once. `with_patches` fills
    // view.patch. The same result for any number of threads. Thread-safe.
    void Render(const CameraPath& path, double time_s, double exposure_s, RenderedView& view,
                bool with_patches = false) const;

  private:
    const Scene& scene_;
    PinholeCamera camera_;
};

}  // namespace tessera
