// The head of a PLY file: which elements follow, with which properties. Used by mesh_io.cpp only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/status.h"

namespace tessera {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t PlyTypeBytes(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::kFloat32;
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;  // of lists
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    // The least that one of it takes in the file.
    std::size_t MinBytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::kAscii;
    std::vector<PlyElement> elements;
    std::size_t body_offset = 0;  // bytes from the file's begin to the first element
};

// `file` is the whole file. Counts are checked against its size: no element claims more than there
// is. Messages do not name the file.
Result<PlyHeader> ParsePlyHeader(std::string_view file);

}  // namespace tessera
