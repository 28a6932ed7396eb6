#include "optimize/place_index.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include "core/check.h"

namespace tessera {
namespace {

// Hamming distance out of 256 bits. Most pairs of the same point are nearer, most of different
// points farther.
constexpr int kNear_bits = 44;
// Larger buckets do not discriminate: blank walls, repeated texture.
constexpr std::uint16_t kFull = 400;

}  // namespace

PlaceIndex::PlaceIndex()
    : newest_(std::size_t{kTables} << kBits, -1), sizes_(std::size_t{kTables} << kBits, 0) {
    std::mt19937 random(20240607);
    for (auto& table : bits_) {
        std::uint8_t all[256];
        std::iota(std::begin(all), std::end(all), std::uint8_t{0});
        for (std::size_t i = 0; i < kBits; ++i) {
            std::swap(all[i], all[i + random() % (256 - i)]);
            table[i] = all[i];
        }
    }
}

std::size_t PlaceIndex::Key(int table, const Descriptor& descriptor) const {
    std::size_t key = static_cast<std::size_t>(table);
    for (const std::uint8_t bit : bits_[table])
        key = key << 1 | static_cast<std::size_t>(descriptor[bit / 64] >> (bit % 64) & 1);
    return key;
}

void PlaceIndex::Add(int keyframe, std::span<const Descriptor> descriptors) {
    TESSERA_CHECK(keyframe >= keyframes_, "keyframe {} is not new", keyframe);
    keyframes_ = keyframe + 1;
    for (const Descriptor& descriptor : descriptors) {
        const auto number = static_cast<std::int32_t>(descriptors_.size());
        descriptors_.push_back(descriptor);
        keyframe_of_.push_back(keyframe);
        for (int table = 0; table < kTables; ++table) {
            const std::size_t key = Key(table, descriptor);
            before_.push_back(std::exchange(newest_[key], number));
            if (sizes_[key] <= kFull) ++sizes_[key];
        }
    }
}

std::vector<PlaceIndex::Candidate> PlaceIndex::Query(std::span<const Descriptor> descriptors,
                                                     int end, int count, int min_votes) const {
    std::vector<int> votes(static_cast<std::size_t>(keyframes_), 0), voted_by(votes.size(), -1);
    for (std::size_t q = 0; q < descriptors.size(); ++q)
        for (int table = 0; table < kTables; ++table) {
            const std::size_t key = Key(table, descriptors[q]);
            if (sizes_[key] > kFull) continue;
            std::int32_t number = newest_[key];
            while (number >= 0) {
                const auto i = static_cast<std::size_t>(number);
                number = before_[i * kTables + static_cast<std::size_t>(table)];
                const auto keyframe = static_cast<std::size_t>(keyframe_of_[i]);
                if (keyframe_of_[i] >= end || voted_by[keyframe] == static_cast<int>(q)) continue;
                if (HammingDistance(descriptors[q], descriptors_[i]) > kNear_bits) continue;
                voted_by[keyframe] = static_cast<int>(q);
                ++votes[keyframe];
            }
        }
    std::vector<Candidate> best;
    for (std::size_t k = 0; k < votes.size(); ++k)
        if (votes[k] >= min_votes) best.push_back({static_cast<int>(k), votes[k]});
    std::ranges::stable_sort(
        best, [](const Candidate& a, const Candidate& b) { return a.votes > b.votes; });
    if (best.size() > static_cast<std::size_t>(count)) best.resize(static_cast<std::size_t>(count));
    return best;
}

}  // namespace tessera
