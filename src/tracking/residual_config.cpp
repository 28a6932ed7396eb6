#include "tracking/residual_model.h"

namespace tessera {

void ResidualModel::Config::Describe(ConfigParameters& p) {
    p.AddChoice("alpha_mode", alpha_mode,
                {{"fixed", AlphaMode::kFixed}, {"auto", AlphaMode::kAuto}},
                "fixed uses alpha; auto estimates it from the residuals of the frames so far");
    p.Add("alpha", alpha, {0.0, 100.0}, "m^2",
          "photometric weight of [B14] eq. 8 (distances in metres, intensities in [0, 1]); 0 uses "
          "geometry only; auto starts from this value");
    p.Add("shading_error", shading_error, {0.0, 1.0}, "",
          "assumed error of intensities over whole image regions (vignetting, moving light, "
          "exposure); lowers their weight where shading is the only texture");
    p.Add("surface_error_voxels", surface_error_voxels, {0.0, 1.0}, "voxels",
          "assumed error of distances over whole image regions, beyond what residuals show");
    p.Add("auto_alpha_max", auto_alpha_max, {1e-4, 100.0}, "m^2",
          "auto: the largest alpha; if intensities dominate, distances no longer show their own "
          "errors");
    p.Add("intensity_scale", intensity_scale, {1e-3, 10.0}, "", "Huber scale of intensities");
    p.Add("remove_shading", remove_shading,
          "leave out what the intensity errors have in common over a thirteenth of the image's "
          "width: vignetting, light that moves or is reflected; off aligns with shading, too");
    p.Add("brightness", brightness,
          "estimate gain and offset of every frame, so that auto-exposure does not distort the "
          "path");
    p.Add("brightness_prior", brightness_prior, {0.0, 10.0}, "",
          "weight of the prior gain 1 and offset 0, per unit of photometric weight; raise it if "
          "exposure is fixed");
    p.Add("doubt_contrast", doubt_contrast, {0.0, 1.0}, "",
          "less than this share of the map's contrast, with twice the usual errors, is no image of "
          "the scene: it is neither tracked nor fused, nor is one that repeats the last; 0: off");
    p.Section("shutter", [&](ConfigParameters& s) { shutter.Describe(s); });
}

}  // namespace tessera
