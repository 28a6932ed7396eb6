// Converts between NumPy arrays and the libraries' images, poses and lists. Input: one copy, with
// element type and shape checked. Output: views of memory that an owner keeps alive, or small
// copies.
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "core/image.h"
#include "core/se3.h"

namespace tessera::python {

// (height, width) float32, metres, any strides. Values that are not finite or not above 0 become 0
// (no measurement). Throws py::type_error for another element type, std::invalid_argument for
// another shape.
DepthImage DepthFrom(const pybind11::array& depth_m, int width, int height);
// (height, width, 3) uint8, RGB. Throws as above.
ColourImage ColourFrom(const pybind11::array& colour, int width, int height);

// (4, 4) float64, row-major.
pybind11::array MatrixOf(const Eigen::Isometry3d& T);
// (3,) float64.
pybind11::array VectorOf(const Eigen::Vector3d& p);
// (N,) and (N, 4, 4) float64; stamps strictly increasing, matrices rigid. Throws as above.
std::vector<StampedPose> PosesFrom(const pybind11::array& stamps_s,
                                   const pybind11::array& T_world_camera);

// A writable (rows, columns) view of Element at `items.data()`. The array keeps `owner` alive.
template <class Element, class Item>
pybind11::array ViewOf(const std::vector<Item>& items, pybind11::ssize_t columns,
                       const pybind11::object& owner) {
    static_assert(sizeof(Item) % sizeof(Element) == 0);
    const std::array<pybind11::ssize_t, 2> shape{static_cast<pybind11::ssize_t>(items.size()),
                                                 columns};
    const std::array<pybind11::ssize_t, 2> strides{sizeof(Item), sizeof(Element)};
    return pybind11::array(pybind11::dtype::of<Element>(), shape, strides, items.data(), owner);
}

}  // namespace tessera::python
