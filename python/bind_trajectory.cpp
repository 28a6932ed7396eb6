// Trajectories. For errors between them, see bind_evaluation.cpp.
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "io/trajectory.h"

namespace tessera::python {
namespace py = pybind11;
namespace {

py::array Stamps(const Trajectory& trajectory) {
    py::array_t<double> array(static_cast<py::ssize_t>(trajectory.poses.size()));
    for (std::size_t i = 0; i < trajectory.poses.size(); ++i)
        array.mutable_at(static_cast<py::ssize_t>(i)) = trajectory.poses[i].stamp_s;
    return array;
}

py::array Matrices(const Trajectory& trajectory) {
    const auto count = static_cast<py::ssize_t>(trajectory.poses.size());
    py::array_t<double> array({count, py::ssize_t{4}, py::ssize_t{4}});
    auto values = array.mutable_unchecked<3>();
    for (py::ssize_t i = 0; i < count; ++i) {
        const auto& matrix = trajectory.poses[static_cast<std::size_t>(i)].T_world_camera.matrix();
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c) values(i, r, c) = matrix(r, c);
    }
    return array;
}

}  // namespace

void BindTrajectory(py::module_& module) {
    py::class_<Trajectory>(module, "Trajectory")
        .def(py::init([](const py::array& stamps_s, const py::array& T_world_camera) {
                 return Trajectory{PosesFrom(stamps_s, T_world_camera), {}};
             }),
             py::arg("stamps_s"), py::arg("T_world_camera"))
        .def_property_readonly("stamps_s", &Stamps)
        .def_property_readonly("T_world_camera", &Matrices)
        .def_readonly("notes", &Trajectory::notes)
        .def(
            "write",
            [](const Trajectory& t, const Path& path) {
                ThrowIfBroken(WriteTrajectory(path.string(), t.poses));
            },
            py::arg("path"))
        .def("__len__", [](const Trajectory& t) { return t.poses.size(); })
        .def("__repr__", [](const Trajectory& t) {
            return fmt::format("<tessera.Trajectory: {} poses>", t.poses.size());
        });
    module.def(
        "read_trajectory",
        [](const Path& path) { return ValueOrBadInput(ReadTrajectory(path.string())); },
        py::arg("path"));
}

}  // namespace tessera::python
