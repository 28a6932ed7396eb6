#include "tracking/icp_tracker.h"

namespace tessera {

void IcpTracker::Config::Describe(ConfigParameters& p) {
    p.AddChoice("prediction", prediction,
                {{"raycast", Prediction::kRayCast}, {"raster", Prediction::kRaster}},
                "where the predicted view comes from: the field, or its mesh drawn by OpenGL "
                "([D18]); without OpenGL the "
                "ray caster steps in");
    p.Add("finest_step_px", finest_step_px, {1, 16}, "px",
          "the finest level takes every so-manieth pixel in both directions, of the frame and of "
          "the predicted view; 1 "
          "is [D18]");
    p.Add("levels", levels, {1, 5}, "", "coarse to fine: each level halves the images");
    p.Add("coarse_iterations", coarse_iterations, {1, 100}, "",
          "most Levenberg-Marquardt steps on the coarsest level");
    p.Add("middle_iterations", middle_iterations, {1, 100}, "", "the same on the levels between");
    p.Add("fine_iterations", fine_iterations, {1, 100}, "", "the same on the finest level");
    p.Add("distance_gate_m", distance_gate_m, {1e-3, 10.0}, "m", "partners farther apart are none");
    p.Add("normal_gate_rad", normal_gate_rad, {0.01, 1.57}, "rad",
          "partners whose normals differ more are none");
    p.Add(
        "normal_radius_px", normal_radius_px, {1, 32}, "px",
        "normals of the measured surface come from differences across so many pixels to each side");
    p.Add("distance_scale_m", distance_scale_m, {1e-4, 10.0}, "m",
          "Huber scale of distances: larger residuals count linearly; larger than the gate is "
          "least squares, [D18]");
    p.Add("depth_exponent", depth_exponent, {0.0, 4.0}, "",
          "a point's weight is (1 m / depth)^this: 4 is the inverse variance of structured light, "
          "0 is [D18]");
}

}  // namespace tessera
