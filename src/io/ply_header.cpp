#include "io/ply_header.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "core/words.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxHeaderBytes = 1 << 20;

std::optional<PlyType> ParseType(std::string_view name) {
    constexpr std::pair<std::string_view, PlyType> kNames[] = {
        {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},
        {"uchar", PlyType::kUint8},    {"uint8", PlyType::kUint8},
        {"short", PlyType::kInt16},    {"int16", PlyType::kInt16},
        {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},
        {"int", PlyType::kInt32},      {"int32", PlyType::kInt32},
        {"uint", PlyType::kUint32},    {"uint32", PlyType::kUint32},
        {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32},
        {"double", PlyType::kFloat64}, {"float64", PlyType::kFloat64}};
    for (const auto& [text, type] : kNames)
        if (text == name) return type;
    return std::nullopt;
}

Status BadLine(std::string_view line) {
    return Status::Error(fmt::format("PLY header: cannot understand '{}'", line.substr(0, 60)));
}

Status ParseFormat(const std::vector<std::string_view>& words, PlyHeader& header) {
    const std::string_view name = words.size() > 1 ? words[1] : "";
    if (name == "ascii")
        header.format = PlyFormat::kAscii;
    else if (name == "binary_little_endian")
        header.format = PlyFormat::kLittleEndian;
    else if (name == "binary_big_endian")
        header.format = PlyFormat::kBigEndian;
    else
        return Status::Error(fmt::format("unknown PLY format '{}'", name.substr(0, 40)));
    return Status::Ok();
}

bool ParseElement(const std::vector<std::string_view>& words, PlyHeader& header) {
    if (words.size() != 3) return false;
    PlyElement element;
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    if (std::from_chars(words[2].data(), end, element.count).ptr != end) return false;
    header.elements.push_back(std::move(element));
    return true;
}

bool ParseProperty(const std::vector<std::string_view>& words, PlyHeader& header) {
    if (header.elements.empty()) return false;
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) return false;
    const auto type = ParseType(words[is_list ? 3 : 1]);
    const auto count_type = ParseType(is_list ? words[2] : "uchar");
    if (!type || !count_type) return false;
    header.elements.back().properties.push_back(
        {std::string(words.back()), *type, is_list, *count_type});
    return true;
}

Status CheckCounts(const PlyHeader& header, std::size_t file_bytes) {
    const std::size_t body = file_bytes - header.body_offset;
    for (const PlyElement& element : header.elements) {
        const std::size_t least = element.MinBytes(header.format);
        // The last number of a text file needs no separator after it.
        if (least > 0 && element.count > (body + 1) / least)
            return Status::Error(fmt::format(
                "claims {} '{}' but the file has only {} bytes; it is truncated or damaged",
                element.count, element.name.substr(0, 40), file_bytes));
    }
    return Status::Ok();
}

}  // namespace

std::size_t PlyTypeBytes(PlyType type) {
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::MinBytes(PlyFormat format) const {
    if (format == PlyFormat::kAscii) return 2 * properties.size();  // a digit and a separator
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties)
        bytes += PlyTypeBytes(property.is_list ? property.count_type : property.type);
    return bytes;
}

Result<PlyHeader> ParsePlyHeader(std::string_view file) {
    PlyHeader header;
    bool has_format = false;
    for (std::size_t begin = 0, number = 1; begin < std::min(file.size(), kMaxHeaderBytes);
         ++number) {
        const std::size_t end = std::min(file.find('\n', begin), file.size());
        const std::string_view line = file.substr(begin, end - begin);
        begin = end + 1;
        const auto words = SplitWords(line.substr(0, 4096), " \t\r");
        if (number == 1 && (words.size() != 1 || words[0] != "ply"))
            return Status::Error("is not a PLY file: it does not start with 'ply'");
        if (number == 1 || words.empty() || words[0] == "comment" || words[0] == "obj_info")
            continue;
        if (words[0] == "end_header") {
            if (!has_format) return Status::Error("PLY header: no format line");
            header.body_offset = std::min(begin, file.size());
            if (Status status = CheckCounts(header, file.size()); !status.ok()) return status;
            return header;
        }
        if (words[0] == "format") {
            has_format = true;
            if (Status status = ParseFormat(words, header); !status.ok()) return status;
        } else if (!(words[0] == "element" && ParseElement(words, header)) &&
                   !(words[0] == "property" && ParseProperty(words, header))) {
            return BadLine(line);
        }
    }
    return Status::Error("PLY header: no end_header; it is truncated or damaged");
}

}  // namespace tessera
