// The errors printed by `tessera eval`.
#include <pybind11/stl.h>

#include "bindings.h"
#include "errors.h"
#include "eval/ate.h"
#include "eval/rpe.h"
#include "io/trajectory.h"

namespace tessera::python {
namespace py = pybind11;

void BindEvaluation(py::module_& module) {
    module.def(
        "evaluate_ate",
        [](const Trajectory& reference, const Trajectory& estimate,
           std::optional<std::int64_t> frames, double max_difference_s) {
            const AteOptions options{.max_difference_s = max_difference_s, .frames = frames};
            return FromJson(
                AteJson(ValueOrBadInput(EvaluateAte(reference.poses, estimate.poses, options))));
        },
        py::arg("reference"), py::arg("estimate"), py::arg("frames") = py::none(),
        py::arg("max_difference_s") = AteOptions().max_difference_s);
    module.def(
        "evaluate_rpe",
        [](const Trajectory& reference, const Trajectory& estimate, double delta_s) {
            if (!(delta_s > 0)) throw std::invalid_argument("delta_s: must be more than 0 seconds");
            return FromJson(RpeJson(ValueOrBadInput(
                EvaluateRpe(reference.poses, estimate.poses, {.delta_s = delta_s}))));
        },
        py::arg("reference"), py::arg("estimate"), py::arg("delta_s") = RpeOptions().delta_s);
}

}  // namespace tessera::python
