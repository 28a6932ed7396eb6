// Cameras, and the frames of any source that the program can open.
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>

#include "arrays.h"
#include "bindings.h"
#include "configure.h"
#include "errors.h"
#include "run/open_source.h"

namespace tessera::python {
namespace py = pybind11;

namespace {

struct CameraFrame {
    Frame frame;
    PinholeCamera camera;
};

// The frames of a source in order. Thread-safe: calls are serialised.
class Frames {
  public:
    Frames(const std::string& source, const RunConfig& config)
        : source_(ValueOrBadInput(OpenSource(source, config))), info_(source_->info()) {}

    const SourceInfo& info() const { return info_; }

    // Reads once. A camera may return kWait.
    ReadResult Read(CameraFrame& frame) {
        const std::lock_guard lock(mutex_);
        frame.camera = info_.camera;
        return source_->Read(frame.frame);
    }

  private:
    std::mutex mutex_;
    std::unique_ptr<FrameSource> source_;
    SourceInfo info_;
};

// Waits for the next frame. Unreadable frames and waiting only raise warnings, so that a loop over
// a recording with a bad image continues.
std::shared_ptr<CameraFrame> NextFrame(Frames& frames) {
    const auto frame = std::make_shared<CameraFrame>();
    while (true) {
        const ReadResult read = [&] {
            const py::gil_scoped_release release;
            return frames.Read(*frame);
        }();
        if (read.status == ReadStatus::kOk) return frame;
        if (read.status == ReadStatus::kEnd) throw py::stop_iteration();
        if (read.status == ReadStatus::kError) throw std::runtime_error(read.message);
        if (!read.message.empty() &&
            PyErr_WarnEx(PyExc_RuntimeWarning, read.message.c_str(), 1) != 0)
            throw py::error_already_set();
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
}

PinholeCamera MakeCamera(int width, int height, double fx, double fy, double cx, double cy) {
    const PinholeCamera camera{width, height, fx, fy, cx, cy};
    ThrowIfBadInput(CheckPlausible(camera));
    return camera;
}

void BindCamera(py::module_& module) {
    py::class_<PinholeCamera>(module, "Camera")
        .def(py::init(&MakeCamera), py::arg("width"), py::arg("height"), py::arg("fx"),
             py::arg("fy"), py::arg("cx"), py::arg("cy"))
        .def_readonly("width", &PinholeCamera::width)
        .def_readonly("height", &PinholeCamera::height)
        .def_readonly("fx", &PinholeCamera::fx)
        .def_readonly("fy", &PinholeCamera::fy)
        .def_readonly("cx", &PinholeCamera::cx)
        .def_readonly("cy", &PinholeCamera::cy)
        .def(py::self == py::self)
        .def("__repr__", [](const PinholeCamera& c) {
            return fmt::format("tessera.Camera(width={}, height={}, fx={}, fy={}, cx={}, cy={})",
                               c.width, c.height, c.fx, c.fy, c.cx, c.cy);
        });
}

py::array DepthOf(const py::object& self) {
    const DepthImage& image = self.cast<const CameraFrame&>().frame.depth_m;
    return py::array(py::dtype::of<float>(), {image.height(), image.width()}, {}, image.data(),
                     self);
}

py::object ColourOf(const py::object& self) {
    const ColourImage& image = self.cast<const CameraFrame&>().frame.colour;
    if (image.empty()) return py::none();
    return py::array(py::dtype::of<std::uint8_t>(), {image.height(), image.width(), 3}, {},
                     image.data(), self);
}

py::object TruthOf(const CameraFrame& frame) {
    return frame.frame.T_world_camera ? py::object(MatrixOf(*frame.frame.T_world_camera))
                                      : py::none();
}

void BindFrame(py::module_& module) {
    py::class_<CameraFrame, std::shared_ptr<CameraFrame>>(module, "Frame")
        .def_property_readonly("index", [](const CameraFrame& f) { return f.frame.index; })
        .def_property_readonly("stamp_s", [](const CameraFrame& f) { return f.frame.stamp_s; })
        .def_property_readonly("colour_stamp_s",
                               [](const CameraFrame& f) { return f.frame.colour_stamp_s; })
        .def_readonly("camera", &CameraFrame::camera)
        .def_property_readonly("depth_m", &DepthOf)
        .def_property_readonly("colour", &ColourOf)
        .def_property_readonly("T_world_camera", &TruthOf)
        .def("__repr__", [](const CameraFrame& f) {
            return fmt::format("<tessera.Frame {} at {:.6f} s>", f.frame.index, f.frame.stamp_s);
        });
}

}  // namespace

void BindFrames(py::module_& module) {
    BindCamera(module);
    BindFrame(module);
    py::class_<Frames>(module, "Frames")
        .def_property_readonly("source", [](const Frames& f) { return f.info().name; })
        .def_property_readonly("kind", [](const Frames& f) { return f.info().kind; })
        .def_property_readonly("camera", [](const Frames& f) { return f.info().camera; })
        .def_property_readonly("frame_count",
                               [](const Frames& f) -> std::optional<std::int64_t> {
                                   return f.info().frame_count < 0
                                              ? std::nullopt
                                              : std::optional(f.info().frame_count);
                               })
        .def_property_readonly("notes", [](const Frames& f) { return f.info().notes; })
        .def_property_readonly("warnings", [](const Frames& f) { return f.info().warnings; })
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &NextFrame);
    module.def(
        "frames",
        [](const Path& source, const std::optional<Path>& config,
           const std::optional<py::dict>& settings) {
            const RunConfig configured = Configure(config, settings);
            const py::gil_scoped_release release;
            return std::make_unique<Frames>(source.string(), configured);
        },
        py::arg("source"), py::arg("config") = py::none(), py::arg("settings") = py::none());
}

}  // namespace tessera::python
