// Meshes and the objects in them.
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "io/mesh_io.h"
#include "semantics/objects_file.h"

namespace tessera::python {
namespace py = pybind11;
namespace {

template <class Element, auto Member>
py::array MeshArray(const py::object& self) {
    return ViewOf<Element>(self.cast<const TriangleMesh&>().*Member, 3, self);
}

// (N,) with the fields class_id and instance.
py::array LabelArray(const py::object& self) {
    const auto& labels = self.cast<const TriangleMesh&>().labels;
    return py::array(py::dtype::of<VertexLabel>(), {static_cast<py::ssize_t>(labels.size())}, {},
                     labels.data(), self);
}

void BindObject(py::module_& module) {
    py::class_<MapObject>(module, "MapObject")
        .def_readonly("id", &MapObject::id)
        .def_readonly("class_id", &MapObject::class_id)
        .def_readonly("class_name", &MapObject::class_name)
        .def_readonly("probability", &MapObject::probability)
        .def_readonly("observations", &MapObject::observations)
        .def_readonly("vertices", &MapObject::vertices)
        .def_property_readonly(
            "colour",
            [](const MapObject& o) { return py::make_tuple(o.colour.r, o.colour.g, o.colour.b); })
        .def_property_readonly("centroid", [](const MapObject& o) { return VectorOf(o.centroid); })
        .def_property_readonly("box_min", [](const MapObject& o) { return VectorOf(o.box.min()); })
        .def_property_readonly("box_max", [](const MapObject& o) { return VectorOf(o.box.max()); })
        .def_property_readonly("T_world_oriented",
                               [](const MapObject& o) { return MatrixOf(o.T_world_oriented); })
        .def_property_readonly("oriented_size",
                               [](const MapObject& o) { return VectorOf(o.oriented_size); })
        .def_property_readonly("embedding",
                               [](const MapObject& o) {
                                   return py::array_t<float>(
                                       static_cast<py::ssize_t>(o.embedding.size()),
                                       o.embedding.data());
                               })
        .def("__repr__", [](const MapObject& o) {
            return fmt::format("<tessera.MapObject {}: {}>", o.id, o.class_name);
        });
}

}  // namespace

void BindMesh(py::module_& module) {
    PYBIND11_NUMPY_DTYPE(VertexLabel, class_id, instance);
    BindObject(module);
    py::class_<TriangleMesh, std::shared_ptr<TriangleMesh>>(module, "Mesh")
        .def_property_readonly("vertices", &MeshArray<float, &TriangleMesh::vertices>)
        .def_property_readonly("normals", &MeshArray<float, &TriangleMesh::normals>)
        .def_property_readonly("colours", &MeshArray<std::uint8_t, &TriangleMesh::colours>)
        .def_property_readonly("triangles", &MeshArray<std::int32_t, &TriangleMesh::triangles>)
        .def_property_readonly("labels", &LabelArray)
        .def(
            "write",
            [](const TriangleMesh& mesh, const Path& path) {
                const py::gil_scoped_release release;
                ThrowIfBroken(WritePly(path.string(), mesh));
            },
            py::arg("path"))
        .def("__repr__", [](const TriangleMesh& m) {
            return fmt::format("<tessera.Mesh: {} vertices, {} triangles>", m.vertices.size(),
                               m.triangles.size());
        });
    module.def(
        "read_mesh",
        [](const Path& path) {
            const py::gil_scoped_release release;
            return std::make_shared<TriangleMesh>(ValueOrBadInput(ReadPly(path.string())));
        },
        py::arg("path"));
    module.def(
        "read_objects",
        [](const Path& path) { return ValueOrBadInput(ReadObjects(path.string())); },
        py::arg("path"));
}

}  // namespace tessera::python
