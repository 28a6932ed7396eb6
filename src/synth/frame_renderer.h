// Renders ideal images of a scene: what a perfect camera would see, with all ground truth. The
// sensor model (sensor_model.h) turns them into measurements.
#pragma once

#include "core/camera.h"
#include "core/config.h"
#include "core/image.h"
#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

// Relative timing and pose of the depth and the colour camera. By default they are one camera with
// a global shutter.
struct CameraRig {
    // Read-out time of the rolling shutter, from the first row to the last.
    double depth_readout_s = 0, colour_readout_s = 0;
    // Delay of the colour exposure after its time stamp.
    double colour_delay_s = 0;
    // Offset of the colour camera to the right of the depth camera.
    double colour_x_m = 0;
    double colour_turn_deg = 0;  // its rotation to the right
    double depth_scale = 1;      // ratio of measured to true depth

    void Describe(ConfigParameters& parameters);
    Eigen::Isometry3d T_depth_colour() const;
};

// Images of equal size. Pixels that see no surface have depth 0, instance and class 0, patch -1 and
// black colour.
struct RenderedView {
    Image<RgbF> colour;          // grey levels [0, 255], averaged over pixel area and exposure
    DepthImage depth_m;          // exact, at the pixel centre and mid-exposure
    Image<float> cos_incidence;  // |cos| between ray and normal
    Image<std::uint16_t> class_id;
    Image<std::uint16_t> instance;
    Image<Mobility> mobility;   // of the surface at this time
    Image<std::int64_t> patch;  // Scene::PatchOf; filled only on request
};

class FrameRenderer {
  public:
    // Keeps a reference to the scene.
    FrameRenderer(const Scene& scene, const PinholeCamera& camera, const CameraRig& rig = {})
        : scene_(scene), camera_(camera), rig_(rig) {}

    // Renders the view at `time_s`, the middle of an exposure of `exposure_s` seconds (0: no motion
    // blur). Four rays per pixel sample the pixel area and the exposure together. `with_patches`
    // fills view.patch. A rolling shutter is simulated in bands of kRowsAtOnce rows. The result
    // does not depend on the number of threads. Thread-safe.
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
