// One function per topic. Each adds its classes and functions to the module.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::python {

using Path = std::filesystem::path;  // str or os.PathLike

// The argument `labels`, as the program takes --labels: "none" is none. Empty: no labels.
inline std::string LabelsFrom(const std::optional<Path>& labels) {
    const std::string name = labels.value_or("").string();
    return name == "none" ? "" : name;
}

void BindMesh(pybind11::module_& module);
void BindTrajectory(pybind11::module_& module);
void BindEvaluation(pybind11::module_& module);
void BindFrames(pybind11::module_& module);   // Camera, Frame, Frames
void BindScanner(pybind11::module_& module);  // call after BindFrames
void BindRun(pybind11::module_& module);

// Converts JSON text to a Python dict or list, so that keys and figures are the same as in the
// program's files.
pybind11::object FromJson(const std::string& json);

}  // namespace tessera::python
