// A whole run, like `tessera run`.
#include <pybind11/stl.h>

#include "bindings.h"
#include "configure.h"
#include "errors.h"
#include "run/run.h"

namespace tessera::python {
namespace py = pybind11;
namespace {

struct RunResult {
    RunSummary summary;
    std::vector<std::string> warnings;
};

RunResult Run(const Path& source, const std::optional<Path>& out, const std::optional<Path>& config,
              const std::optional<py::dict>& settings, const std::optional<Path>& labels,
              std::int64_t start, std::optional<std::int64_t> frames, std::int64_t stride) {
    RunRequest request;
    request.source = source.string();
    request.output_folder = out.value_or("").string();
    request.labels = LabelsFrom(labels);
    request.selection = {start, frames.value_or(-1), stride};
    request.command_line = {"tessera.run"};
    const RunConfig configured = Configure(config, settings);
    RunResult result;
    std::atomic<bool> stop{false};
    std::optional<py::error_already_set> interrupt;
    RunObserver observer;
    bool begun = false;
    observer.on_open = [&](const SourceInfo&) { begun = true; };
    observer.on_warning = [&](const std::string& text) { result.warnings.push_back(text); };
    // Ctrl-C ends the run after the current frame. Its files are then complete, as with the
    // program.
    observer.on_frame = [&](const RunCounts&, std::int64_t) {
        const py::gil_scoped_acquire acquire;
        if (interrupt || PyErr_CheckSignals() == 0) return;
        interrupt.emplace();
        stop.store(true);
    };
    {
        const py::gil_scoped_release release;
        Result<RunSummary> summary = ExecuteRun(request, configured, observer, stop);
        if (begun) ThrowIfBroken(summary.status());
        result.summary = ValueOrBadInput(std::move(summary));
    }
    if (interrupt) throw *interrupt;
    return result;
}

}  // namespace

void BindRun(py::module_& module) {
    py::class_<RunResult>(module, "RunResult")
        .def_property_readonly("frames", [](const RunResult& r) { return r.summary.counts.frames; })
        .def_property_readonly("tracked",
                               [](const RunResult& r) { return r.summary.counts.tracked; })
        .def_property_readonly("fused", [](const RunResult& r) { return r.summary.counts.fused; })
        .def_property_readonly("lost", [](const RunResult& r) { return r.summary.counts.lost; })
        .def_property_readonly("skipped",
                               [](const RunResult& r) { return r.summary.counts.skipped; })
        .def_property_readonly("wall_s", [](const RunResult& r) { return r.summary.wall_s; })
        .def_property_readonly("fps", [](const RunResult& r) { return r.summary.fps; })
        .def_property_readonly("ate",
                               [](const RunResult& r) -> py::object {
                                   return r.summary.ate ? FromJson(AteJson(*r.summary.ate))
                                                        : py::none();
                               })
        .def_readonly("warnings", &RunResult::warnings)
        .def("__repr__", [](const RunResult& r) {
            const RunCounts& counts = r.summary.counts;
            return fmt::format("<tessera.RunResult: {} of {} frames tracked>", counts.tracked,
                               counts.frames);
        });
    module.def("run", &Run, py::arg("source"), py::arg("out") = py::none(),
               py::arg("config") = py::none(), py::arg("settings") = py::none(),
               py::arg("labels") = py::none(), py::arg("start") = 0, py::arg("frames") = py::none(),
               py::arg("stride") = 1);
}

}  // namespace tessera::python
