// How much the residuals of one frame err, from their sums over neighbourhoods.
// docs/information.md has the derivation.
#pragma once

#include "tracking/residual_model.h"

namespace tessera {

// Distance variance from the sums over patches (DistanceSums). A patch's Hessian is that of its
// mean Jacobian. `shared_m` is an error of the whole patch that no residual shows.
double DistanceVariance(const ResidualEvidence& evidence, double shared_m);

struct IntensityErrors {
    // Of a residual in a sum whose gradients are the frame's, as for alpha; 0: too few regions.
    double variance = 0;
    // The same in the Hessian, whose gradients are the map's: their sum. Before a bare wall the
    // frame's gradients are noise, which hides that all the map has is shading.
    double scatter = 0, shading = 0;
    // The fraction of the map's gradients that the frame's gradients confirm.
    double texture = 1;
};

// From ScoreSums, whose scores are residual times image gradient over depth. Errors at edges, where
// the gradient is large, count by their pull on the pose. Adds the error that a whole block shares
// (`shading_error`, intensities in [0, 1]). That error hardly pulls where texture has gradients of
// all signs, but strongly where shading is the only gradient, and residuals against a map of the
// same shading do not show it. The noise of the frame's and of the map's gradients is independent
// and confirms nothing. Nor does what the gradients of a block have in common: it may be the
// shading of both.
IntensityErrors IntensityErrorsOf(const ResidualEvidence& evidence, double shading_error);

}  // namespace tessera
