// Writes small ONNX networks by hand, for tests of what no downloaded model covers.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tessera {

// The bytes of protocol buffer fields.
inline std::string VarintBytes(std::uint64_t value) {
    std::string bytes;
    for (; value > 127; value >>= 7) bytes += static_cast<char>((value & 127) | 128);
    return bytes + static_cast<char>(value);
}
inline std::string Field(int number, const std::string& bytes) {
    return VarintBytes(static_cast<std::uint64_t>(number << 3 | 2)) + VarintBytes(bytes.size()) +
           bytes;
}
inline std::string Field(int number, int value) {
    return VarintBytes(static_cast<std::uint64_t>(number << 3)) +
           VarintBytes(static_cast<std::uint64_t>(value));
}

// The name and shape of an input or output of floats.
inline std::string OnnxValue(const std::string& name, const std::vector<int>& shape) {
    std::string sizes;
    for (const int size : shape) sizes += Field(1, Field(1, size));
    return Field(1, name) + Field(2, Field(1, Field(1, 1) + Field(2, sizes)));
}

// A constant of floats (type 1) or of 64-bit integers (type 7).
template <typename T>
std::string OnnxTensor(const std::string& name, const std::vector<int>& shape,
                       const std::vector<T>& values) {
    std::string tensor, raw(values.size() * sizeof(T), '\0');
    for (const int size : shape) tensor += Field(1, size);
    std::memcpy(raw.data(), values.data(), raw.size());
    return tensor + Field(2, sizeof(T) == 4 ? 1 : 7) + Field(8, name) + Field(9, raw);
}

// An attribute of integers (type 7).
inline std::string OnnxIntegers(const std::string& name, const std::vector<int>& values) {
    std::string attribute = Field(1, name) + Field(20, 7);
    for (const int value : values) attribute += Field(8, value);
    return Field(5, attribute);
}

inline std::string OnnxNode(const std::string& type, const std::vector<std::string>& inputs,
                            const std::string& output, const std::string& attributes = {}) {
    std::string node;
    for (const std::string& input : inputs) node += Field(1, input);
    return Field(1, node + Field(2, output) + Field(3, output) + Field(4, type) + attributes);
}

// `nodes` and `constants` are joined nodes and Field(5, OnnxTensor(...)).
inline std::string OnnxModel(const std::string& nodes, const std::string& constants,
                             const std::vector<std::string>& inputs,
                             const std::vector<std::string>& outputs) {
    std::string graph = nodes + Field(2, "g") + constants;
    for (const std::string& input : inputs) graph += Field(11, input);
    for (const std::string& output : outputs) graph += Field(12, output);
    return Field(1, 7) + Field(7, graph) + Field(8, Field(1, "") + Field(2, 11));
}

}  // namespace tessera
