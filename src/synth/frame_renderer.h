// Ideal pictures of a scene: what a perfect camera would see, with all truth. The sensor model
// (sensor_model.h) makes measurements of them.
#pragma once

#include "core/camera.h"
#include "core/config.h"
#include "core/image.h"
#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

// How the depth and the colour camera stand to each other, in time and space. As it is: one camera,
// all of it at one instant.
struct CameraRig {
    // Rolling shutter, from the first row to the last.
    double depth_readout_s = 0, colour_readout_s = 0;
    // Colour is taken so much after its time stamp.
    double colour_delay_s = 0;
    // The colour camera's place to the right of the depth camera.
    double colour_x_m = 0;
    double colour_turn_deg = 0;  // and its turn to the right
    double depth_scale = 1;      // measured depth over true

    void Describe(ConfigParameters& parameters);
    Eigen::Isometry3d T_depth_colour() const;
};

// Images of one size. Where no surface is seen: depth 0, instance and class 0, patch -1, colour
// black.
struct RenderedView {
    Image<RgbF> colour;          // grey levels [0, 255], averaged over the pixel and the exposure
    DepthImage depth_m;          // exact, through the pixel's centre, at mid-exposure
    Image<float> cos_incidence;  // |cos| between ray and normal
    Image<std::uint16_t> class_id;
    Image<std::uint16_t> instance;
    Image<Mobility> mobility;   // of the surface at that time
    Image<std::int64_t> patch;  // Scene::PatchOf; empty unless asked for
};

class FrameRenderer {
  public:
    // Refers to the scene.
    FrameRenderer(const Scene& scene, const PinholeCamera& camera, const CameraRig& rig = {})
        : scene_(scene), camera_(camera), rig_(rig) {}

    // The view at `time_s`, the middle of an exposure of `exposure_s` seconds (0: no motion blur).
    // Four rays a pixel sample the pixel's area and the exposure at once. `with_patches` fills
    // view.patch. A rolling shutter reads bands of kRowsAtOnce rows together. The same result for
    // any number of threads. Thread-safe.
    void Render(const CameraPath& path, double time_s, double exposure_s, RenderedView& view,
                bool with_patches = false) const;

  private:
    static constexpr int kRowsAtOnce = 4;
    // Rows from first_row to last_row - 1.
    void RenderBand(const CameraPath& path, double time_s, double exposure_s, int first_row,
                    int last_row, RenderedView& view) const;

    const Scene& scene_;
    PinholeCamera camera_;
    CameraRig rig_;
};

}  // namespace tessera
