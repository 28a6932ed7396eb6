// The scan driven by the caller.
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "configure.h"
#include "io/trajectory.h"
#include "scanner.h"

namespace tessera::python {
namespace py = pybind11;
namespace {

std::unique_ptr<Scanner> MakeScanner(const PinholeCamera& camera, const std::optional<Path>& config,
                                     const std::optional<py::dict>& settings,
                                     const std::optional<Path>& labels) {
    const RunConfig configured = Configure(config, settings);
    const py::gil_scoped_release release;
    return std::make_unique<Scanner>(camera, configured, LabelsFrom(labels));
}

FrameResult Track(Scanner& scanner, const py::array& depth_m,
                  const std::optional<py::array>& colour, double stamp_s,
                  std::optional<double> colour_stamp_s) {
    const PinholeCamera& camera = scanner.camera();
    Frame frame;
    frame.stamp_s = stamp_s;
    frame.colour_stamp_s = colour_stamp_s.value_or(stamp_s);
    frame.depth_m = DepthFrom(depth_m, camera.width, camera.height);
    if (colour) frame.colour = ColourFrom(*colour, camera.width, camera.height);
    const py::gil_scoped_release release;
    return scanner.Track(std::move(frame));
}

py::object PoseOf(const FrameResult& result) {
    return result.report.tracked() ? py::object(MatrixOf(result.report.track.T_world_camera))
                                   : py::none();
}

void BindFrameResult(py::module_& module) {
    py::class_<FrameResult>(module, "FrameResult")
        .def_property_readonly("index", [](const FrameResult& r) { return r.report.index; })
        .def_property_readonly("stamp_s", [](const FrameResult& r) { return r.report.stamp_s; })
        .def_property_readonly("tracked", [](const FrameResult& r) { return r.report.tracked(); })
        .def_property_readonly("fused", [](const FrameResult& r) { return r.report.fused; })
        .def_property_readonly("T_world_camera", &PoseOf)
        .def_property_readonly("status",
                               [](const FrameResult& r) { return ToString(r.report.track.status); })
        .def_property_readonly("reason", [](const FrameResult& r) { return r.report.track.reason; })
        .def_property_readonly("inlier_fraction",
                               [](const FrameResult& r) { return r.report.track.inlier_fraction; })
        .def_property_readonly("milliseconds", [](const FrameResult& r) { return r.frame_ms; })
        .def_readonly("messages", &FrameResult::messages)
        .def("__repr__", [](const FrameResult& r) {
            const FrameReport& report = r.report;
            return fmt::format("<tessera.FrameResult {}: {}, {:.1f} ms>", report.index,
                               ToString(report.track.status), r.frame_ms);
        });
}

}  // namespace

void BindScanner(py::module_& module) {
    const auto unlocked = py::call_guard<py::gil_scoped_release>();
    BindFrameResult(module);
    py::class_<Scanner>(module, "Scanner")
        .def(py::init(&MakeScanner), py::arg("camera"), py::arg("config") = py::none(),
             py::arg("settings") = py::none(), py::arg("labels") = py::none())
        .def_property_readonly("camera", &Scanner::camera)
        .def("track", &Track, py::arg("depth_m"), py::arg("colour").none(true), py::arg("stamp_s"),
             py::arg("colour_stamp_s") = py::none())
        .def("mesh", &Scanner::Mesh, unlocked)
        .def(
            "trajectory",
            [](const Scanner& scanner) {
                return Trajectory{scanner.Path(), {}};
            },
            unlocked)
        .def("finish", &Scanner::Finish, unlocked)
        .def("objects", &Scanner::Objects, unlocked);
}

}  // namespace tessera::python
