// PLY header: the elements of the file and their properties. Used by mesh_io.cpp only.
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

    // The minimum size of one element in the file.
    std::size_t MinBytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::kAscii;
    std::vector<PlyElement> elements;
    std::size_t body_offset = 0;  // bytes from the start of the file to the first element
};

// `file` is the whole file. Checks that no element count exceeds what the file can hold. Messages
// do not name the file.
Result<PlyHeader> ParsePlyHeader(std::string_view file);

}  // namespace tessera
