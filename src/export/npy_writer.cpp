#include "export/npy_writer.h"

#include <fmt/format.h>

#include <bit>
#include <string_view>

#include "io/file.h"

namespace tessera {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

Status Write(const std::string& path, const char* type, std::string_view bytes, int depth,
             int height, int width) {
    constexpr std::size_t kAlign = 64, kPreamble = 10;  // magic, version and length
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}, {}), }}", type,
                    depth, height, width);
    header.append(kAlign - 1 - (kPreamble + header.size()) % kAlign, ' ');
    header += '\n';
    AtomicFile file(path);
    file.Write({"\x93NUMPY\x01\x00", 8});
    const char length[2] = {static_cast<char>(header.size() & 255),
                            static_cast<char>(header.size() >> 8)};
    file.Write({length, 2});
    file.Write(header);
    file.Write(bytes);
    return file.Commit();
}

}  // namespace

Status WriteNpy(const std::string& path, std::span<const float> values, int depth, int height,
                int width) {
    return Write(path, "<f4", {reinterpret_cast<const char*>(values.data()), values.size_bytes()},
                 depth, height, width);
}

Status WriteNpy(const std::string& path, std::span<const std::uint8_t> values, int depth,
                int height, int width) {
    return Write(path, "|u1", {reinterpret_cast<const char*>(values.data()), values.size_bytes()},
                 depth, height, width);
}

}  // namespace tessera
