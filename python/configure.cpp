#include "configure.h"

#include "errors.h"

namespace tessera::python {
namespace py = pybind11;
namespace {

std::string TextOf(const py::handle& value) {
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    return py::str(value);
}

}  // namespace

RunConfig Configure(const std::optional<std::filesystem::path>& config,
                    const std::optional<py::dict>& settings) {
    RunConfig result;
    ConfigParameters parameters;
    result.Describe(parameters);
    if (config) ThrowIfBadInput(LoadPresetOrFile(config->string(), parameters));
    if (settings)
        for (const auto& [key, value] : *settings)
            ThrowIfBadInput(parameters.Set(py::str(key), TextOf(value)));
    return result;
}

}  // namespace tessera::python
