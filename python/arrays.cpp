#include "arrays.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>

namespace tessera::python {
namespace py = pybind11;
namespace {

std::string ShapeOf(const py::array& array) { return py::str(array.attr("shape")); }

template <class Element>
void CheckType(const py::array& array, const char* name, const char* expected, const char* hint) {
    if (py::isinstance<py::array_t<Element>>(array)) return;
    const std::string type = py::str(array.dtype());
    throw py::type_error(fmt::format("{}: expected {}, got {}{}", name, expected, type, hint));
}

void CheckShape(const py::array& array, const std::vector<py::ssize_t>& shape, const char* name) {
    if (std::equal(shape.begin(), shape.end(), array.shape(), array.shape() + array.ndim())) return;
    throw std::invalid_argument(fmt::format("{}: expected shape {}, got {}", name,
                                            std::string(py::str(py::tuple(py::cast(shape)))),
                                            ShapeOf(array)));
}

Eigen::Isometry3d RigidFrom(const double (&m)[4][4], py::ssize_t index) {
    Eigen::Isometry3d T;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) T.matrix()(r, c) = m[r][c];
    const Eigen::Matrix3d R = T.linear();
    const bool rigid =
        T.matrix().allFinite() && T.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
        (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
        R.determinant() > 0;
    if (!rigid)
        throw std::invalid_argument(fmt::format(
            "T_world_camera[{}]: not a rigid transform (rotation and translation)", index));
    return T;
}

}  // namespace

DepthImage DepthFrom(const py::array& depth_m, int width, int height) {
    CheckType<float>(depth_m, "depth_m", "float32 in metres",
                     "; to convert from millimetres: depth.astype('float32') / 1000");
    CheckShape(depth_m, {height, width}, "depth_m");
    const auto values = py::array_t<float>(depth_m).unchecked<2>();
    DepthImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float z = values(y, x);
            image(x, y) = std::isfinite(z) && z > 0 ? z : 0;
        }
    return image;
}

ColourImage ColourFrom(const py::array& colour, int width, int height) {
    CheckType<std::uint8_t>(colour, "colour", "uint8 RGB", "");
    CheckShape(colour, {height, width, 3}, "colour");
    const auto values = py::array_t<std::uint8_t>(colour).unchecked<3>();
    ColourImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image(x, y) = {values(y, x, 0), values(y, x, 1), values(y, x, 2)};
    return image;
}

py::array MatrixOf(const Eigen::Isometry3d& T) {
    py::array_t<double> array({4, 4});
    auto values = array.mutable_unchecked<2>();
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) values(r, c) = T.matrix()(r, c);
    return array;
}

py::array VectorOf(const Eigen::Vector3d& p) {
    py::array_t<double> array(3);
    for (int i = 0; i < 3; ++i) array.mutable_at(i) = p[i];
    return array;
}

std::vector<StampedPose> PosesFrom(const py::array& stamps_s, const py::array& T_world_camera) {
    CheckType<double>(stamps_s, "stamps_s", "float64", "");
    CheckType<double>(T_world_camera, "T_world_camera", "float64", "");
    if (stamps_s.ndim() != 1)
        throw std::invalid_argument("stamps_s: expected shape (N,), got " + ShapeOf(stamps_s));
    const py::ssize_t count = stamps_s.shape(0);
    CheckShape(T_world_camera, {count, 4, 4}, "T_world_camera");
    const auto stamps = py::array_t<double>(stamps_s).unchecked<1>();
    const auto matrices = py::array_t<double>(T_world_camera).unchecked<3>();
    std::vector<StampedPose> poses;
    for (py::ssize_t i = 0; i < count; ++i) {
        if (!std::isfinite(stamps(i)) || (i > 0 && stamps(i) <= stamps(i - 1)))
            throw std::invalid_argument(
                fmt::format("stamps_s[{}]: {} is not later than the previous stamp", i, stamps(i)));
        double m[4][4];
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c) m[r][c] = matrices(i, r, c);
        poses.push_back({stamps(i), RigidFrom(m, i)});
    }
    return poses;
}

}  // namespace tessera::python
