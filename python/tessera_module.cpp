// The extension module tessera._tessera. Users import the package around it: tessera/__init__.py,
// documented and typed in tessera/__init__.pyi.
#include "bindings.h"

namespace tessera::python {

pybind11::object FromJson(const std::string& json) {
    return pybind11::module_::import("json").attr("loads")(json);
}

}  // namespace tessera::python

PYBIND11_MODULE(_tessera, module) {
    using namespace tessera::python;
    module.attr("__version__") = TESSERA_VERSION;
    BindMesh(module);
    BindTrajectory(module);
    BindEvaluation(module);
    BindFrames(module);
    BindScanner(module);
    BindRun(module);
}
