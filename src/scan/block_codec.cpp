#include "scan/block_codec.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "core/refill.h"

namespace tessera {
namespace {

constexpr std::size_t kNumberBytes = sizeof(std::int32_t);
constexpr std::size_t kLayerBytes =
    kBlockVoxels * (sizeof(FieldWord) + sizeof(std::uint16_t) + sizeof(ColourWord));
constexpr std::size_t kLabelBytes = kBlockVoxels * sizeof(VoxelLabel);

// Splits the values into byte planes: byte b of every element, for each b in turn.
template <class T>
std::uint8_t* ToPlanes(const T* values, std::uint8_t* out) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
    for (std::size_t b = 0; b < sizeof(T); ++b)
        for (std::size_t i = 0; i < kBlockVoxels; ++i) *out++ = bytes[i * sizeof(T) + b];
    return out;
}

template <class T>
const std::uint8_t* FromPlanes(const std::uint8_t* in, T* values) {
    auto* bytes = reinterpret_cast<std::uint8_t*>(values);
    for (std::size_t b = 0; b < sizeof(T); ++b)
        for (std::size_t i = 0; i < kBlockVoxels; ++i) bytes[i * sizeof(T) + b] = *in++;
    return in;
}

std::size_t ContentBytes(std::span<const std::uint8_t> data) {
    if (data.size() <= kNumberBytes) return 0;
    const std::uint64_t size = Compressor::ContentSize(data.subspan(kNumberBytes));
    return size == kLayerBytes || size == kLayerBytes + kLabelBytes ? static_cast<std::size_t>(size)
                                                                    : 0;
}

}  // namespace

void BlockCopies::Copy(const BlockMap& map, std::span<const BlockId> blocks) {
    const std::size_t voxels = blocks.size() * kBlockVoxels;
    Refill(blocks.size(), numbers);
    Refill(blocks.size(), coords);
    Refill(voxels, field);
    Refill(voxels, weight);
    Refill(voxels, colour);
    Refill(map.has_labels() ? voxels : 0, labels);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 64),
                      [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              const BlockId id = blocks[i];
                              const std::size_t at = i * kBlockVoxels;
                              numbers[i] = map.number(id);
                              coords[i] = map.coord(id);
                              std::copy_n(map.field(id), kBlockVoxels, field.data() + at);
                              std::copy_n(map.weight(id), kBlockVoxels, weight.data() + at);
                              std::copy_n(map.colour(id), kBlockVoxels, colour.data() + at);
                              if (map.has_labels())
                                  std::copy_n(map.label(id), kBlockVoxels, labels.data() + at);
                          }
                      });
}

void BlockCopies::Append(const BlockCoord& coord, std::int32_t number, bool with_labels) {
    numbers.push_back(number);
    coords.push_back(coord);
    const std::size_t voxels = numbers.size() * kBlockVoxels;
    field.resize(voxels);
    weight.resize(voxels);
    colour.resize(voxels);
    if (with_labels || !labels.empty()) labels.resize(voxels);
}

void BlockCopies::Put(std::size_t index, BlockMap& map, BlockId id) const {
    const std::size_t at = index * kBlockVoxels;
    std::copy_n(field.data() + at, kBlockVoxels, map.field(id));
    std::copy_n(weight.data() + at, kBlockVoxels, map.weight(id));
    std::copy_n(colour.data() + at, kBlockVoxels, map.colour(id));
    if (map.has_labels() && !labels.empty())
        std::copy_n(labels.data() + at, kBlockVoxels, map.label(id));
}

std::vector<std::pair<std::int64_t, std::size_t>> BlockCopies::ByKey() const {
    std::vector<std::pair<std::int64_t, std::size_t>> order;
    for (std::size_t i = 0; i < size(); ++i) order.emplace_back(BlockKey(coords[i]), i);
    std::ranges::sort(order);
    return order;
}

void BlockCopies::Clear() {
    numbers.clear();
    coords.clear();
    field.clear();
    weight.clear();
    colour.clear();
    labels.clear();
}

const std::vector<std::uint8_t>& BlockCodec::Encode(const BlockCopies& copies, std::size_t index) {
    const std::size_t at = index * kBlockVoxels;
    content_.resize(kLayerBytes + (copies.labels.empty() ? 0 : kLabelBytes));
    std::uint8_t* out = ToPlanes(copies.field.data() + at, content_.data());
    out = ToPlanes(copies.weight.data() + at, out);
    out = ToPlanes(copies.colour.data() + at, out);
    if (!copies.labels.empty()) ToPlanes(copies.labels.data() + at, out);
    data_.resize(kNumberBytes);
    std::memcpy(data_.data(), &copies.numbers[index], kNumberBytes);
    compressor_.Compress(content_, data_);
    return data_;
}

std::optional<std::int32_t> BlockCodec::NumberOf(std::span<const std::uint8_t> data) {
    if (ContentBytes(data) == 0) return std::nullopt;
    std::int32_t number;
    std::memcpy(&number, data.data(), kNumberBytes);
    return number;
}

bool BlockCodec::Decode(std::int64_t key, std::span<const std::uint8_t> data, BlockCopies& copies) {
    const std::optional<std::int32_t> number = NumberOf(data);
    if (!number) return false;
    content_.resize(ContentBytes(data));
    if (!compressor_.Decompress(data.subspan(kNumberBytes), content_)) return false;
    const std::size_t at = copies.size() * kBlockVoxels;
    const bool labels = content_.size() == kLayerBytes + kLabelBytes;
    copies.Append(CoordOfKey(key), *number, labels);
    const std::uint8_t* in = FromPlanes(content_.data(), copies.field.data() + at);
    in = FromPlanes(in, copies.weight.data() + at);
    in = FromPlanes(in, copies.colour.data() + at);
    if (labels) FromPlanes(in, copies.labels.data() + at);
    return true;
}

}  // namespace tessera
