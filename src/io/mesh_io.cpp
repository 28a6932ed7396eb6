#include "io/mesh_io.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <string_view>

#include "core/input_file.h"
#include "io/ply_header.h"
#include "io/ply_scalars.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxMeshBytes = std::size_t{16} << 30;
constexpr std::uint64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();

// Destination of a vertex property; kNone is skipped.
enum Slot {
    kX,
    kY,
    kZ,
    kNx,
    kNy,
    kNz,
    kRed,
    kGreen,
    kBlue,
    kClass,
    kInstance,
    kSlots,
    kNone = kSlots
};

Slot SlotOf(std::string_view name) {
    // clang-format off
    constexpr std::pair<std::string_view, Slot> kNames[] = {
        {"x", kX},   {"y", kY},   {"z", kZ},
        {"nx", kNx}, {"ny", kNy}, {"nz", kNz},
        {"normal_x", kNx}, {"normal_y", kNy}, {"normal_z", kNz},
        {"red", kRed}, {"green", kGreen}, {"blue", kBlue},
        {"r", kRed},   {"g", kGreen},     {"b", kBlue},
        {"diffuse_red", kRed}, {"diffuse_green", kGreen}, {"diffuse_blue", kBlue},
        {"class", kClass}, {"instance", kInstance}};
    // clang-format on
    for (const auto& [text, slot] : kNames)
        if (text == name) return slot;
    return kNone;
}

// Factor from the stored value to the range 0 to 255. Colours are bytes, 16-bit integers, or floats
// from 0 to 1.
double ColourScale(PlyType type) {
    if (type == PlyType::kFloat32 || type == PlyType::kFloat64) return 255.0;
    return type == PlyType::kUint16 ? 255.0 / 65535.0 : 1.0;
}

std::uint8_t ToByte(double value) {
    return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0))) : 0;
}

std::uint16_t ToIndex(double value) {
    return value > 0 ? static_cast<std::uint16_t>(std::lround(std::min(value, 65535.0)))
                     : std::uint16_t{0};
}

// Normalises to unit length; zero if that is impossible.
Eigen::Vector3f ToNormal(const double* n) {
    const Eigen::Vector3d normal(n[0], n[1], n[2]);
    const double length = normal.norm();
    if (!std::isfinite(length) || length < 1e-12) return Eigen::Vector3f::Zero();
    if (std::abs(length - 1) < 1e-4) return normal.cast<float>();
    return (normal / length).cast<float>();
}

void SkipProperty(const PlyProperty& property, PlyScalars& scalars) {
    std::uint64_t count = property.is_list ? scalars.ReadCount(property.count_type) : 1;
    scalars.Skip(property.type, count);
}

Status ReadVertices(const PlyElement& element, PlyScalars& scalars, TriangleMesh& mesh) {
    std::vector<Slot> slots;
    std::array<bool, kSlots + 1> has{};
    std::array<double, kSlots + 1> scale;
    scale.fill(1.0);
    for (const PlyProperty& property : element.properties) {
        slots.push_back(property.is_list ? kNone : SlotOf(property.name));
        has[slots.back()] = true;
        if (slots.back() >= kRed && slots.back() <= kBlue)
            scale[slots.back()] = ColourScale(property.type);
    }
    if (!has[kX] || !has[kY] || !has[kZ]) return Status::Error("its vertices have no x, y, z");
    if (element.count > kMaxIndex) return Status::Error("has more than 2^31 vertices");
    const bool has_normals = has[kNx] && has[kNy] && has[kNz];
    const bool has_colours = has[kRed] && has[kGreen] && has[kBlue];
    mesh.vertices.reserve(element.count);
    if (has_normals) mesh.normals.reserve(element.count);
    if (has_colours) mesh.colours.reserve(element.count);
    const bool has_labels = has[kClass] && has[kInstance];
    if (has_labels) mesh.labels.reserve(element.count);

    std::array<double, kSlots> v{};
    for (std::uint64_t i = 0; i < element.count && scalars.ok(); ++i) {
        for (std::size_t p = 0; p < slots.size(); ++p) {
            if (slots[p] == kNone)
                SkipProperty(element.properties[p], scalars);
            else
                v[slots[p]] = scale[slots[p]] * scalars.Read(element.properties[p].type);
        }
        mesh.vertices.push_back(Eigen::Vector3d(v[kX], v[kY], v[kZ]).cast<float>());
        if (!mesh.vertices.back().allFinite())
            return Status::Error(fmt::format("vertex {} is not finite; remove such vertices", i));
        if (has_normals) mesh.normals.push_back(ToNormal(&v[kNx]));
        if (has_colours)
            mesh.colours.push_back({ToByte(v[kRed]), ToByte(v[kGreen]), ToByte(v[kBlue])});
        if (has_labels) mesh.labels.push_back({ToByte(v[kClass]), ToIndex(v[kInstance])});
    }
    return Status::Ok();
}

// Splits a polygon into a triangle fan around its first corner.
void ReadPolygon(const PlyProperty& property, std::uint64_t corners, PlyScalars& scalars,
                 TriangleMesh& mesh) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint64_t i = 0; i < corners && scalars.ok(); ++i) {
        const double index = scalars.Read(property.type);
        // An invalid index becomes out of range, which is checked once all vertices are known.
        const bool valid = index >= 0 && index <= static_cast<double>(kMaxIndex);
        triangle[std::min<std::uint64_t>(i, 2)] = valid ? static_cast<std::uint32_t>(index) : ~0u;
        if (i < 2) continue;
        if (scalars.ok()) mesh.triangles.push_back(triangle);
        triangle[1] = triangle[2];
    }
}

// A fan needs up to twelve times the polygon's bytes, so polygons have at most as many corners as
// there are vertices, and the mesh at most 2^31 triangles.
Status ReadFaces(const PlyElement& element, std::uint64_t vertices, PlyScalars& scalars,
                 TriangleMesh& mesh) {
    if (element.count > kMaxIndex) return Status::Error("has more than 2^31 faces");
    mesh.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count && scalars.ok(); ++i)
        for (const PlyProperty& property : element.properties) {
            if (!property.is_list ||
                (property.name != "vertex_indices" && property.name != "vertex_index")) {
                SkipProperty(property, scalars);
                continue;
            }
            const std::uint64_t corners = scalars.ReadCount(property.count_type);
            if (corners > vertices)
                return Status::Error(
                    fmt::format("face {} has {} corners, but there are only {} vertices", i,
                                corners, vertices));
            if (mesh.triangles.size() + corners > kMaxIndex)
                return Status::Error("has more than 2^31 triangles");
            ReadPolygon(property, corners, scalars, mesh);
        }
    return Status::Ok();
}

Status ReadBody(const PlyHeader& header, PlyScalars scalars, TriangleMesh& mesh) {
    bool has_vertices = false;
    std::uint64_t vertices = 0;
    for (const PlyElement& element : header.elements)
        if (element.name == "vertex") vertices = element.count;
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty()) continue;
        if (element.name == "vertex") {
            if (std::exchange(has_vertices, true)) return Status::Error("has two vertex lists");
            if (Status status = ReadVertices(element, scalars, mesh); !status.ok()) return status;
        } else if (element.name == "face") {
            if (Status status = ReadFaces(element, vertices, scalars, mesh); !status.ok())
                return status;
        } else {
            for (std::uint64_t i = 0; i < element.count && scalars.ok(); ++i)
                for (const PlyProperty& property : element.properties)
                    SkipProperty(property, scalars);
        }
        if (!scalars.ok())
            return Status::Error(fmt::format("is truncated or damaged in its '{}' list",
                                             element.name.substr(0, 40)));
    }
    if (!has_vertices) return Status::Error("has no vertices");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle)
            if (index >= mesh.vertices.size())
                return Status::Error(fmt::format("a face refers to vertex {} of {}",
                                                 static_cast<std::int32_t>(index),
                                                 mesh.vertices.size()));
    return Status::Ok();
}

Status ParsePly(std::string_view file, TriangleMesh& mesh) {
    const Result<PlyHeader> header = ParsePlyHeader(file);
    if (!header.ok()) return header.status();
    const std::string_view body = file.substr(header.value().body_offset);
    return ReadBody(header.value(), PlyScalars(body, header.value().format), mesh);
}

}  // namespace

Result<TriangleMesh> ReadPly(const std::string& path) {
    const Result<std::string> file = ReadWholeFile(path, kMaxMeshBytes);
    if (!file.ok()) return file.status();
    TriangleMesh mesh;
    try {
        const Status status = ParsePly(file.value(), mesh);
        if (!status.ok()) return Status::Error(path + ": " + status.message());
    } catch (const std::bad_alloc&) {
        return Status::Error(path + ": the mesh does not fit in memory");
    }
    return mesh;
}

}  // namespace tessera
