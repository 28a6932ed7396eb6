#include "optimize/place_index.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "core/check.h"

namespace tessera {
namespace {

// Hamming distance out of 256 bits. Most pairs of the same point are nearer, most of different
// points farther.
constexpr int kNear_bits = 44;
// Larger buckets do not discriminate: blank walls, repeated texture.
constexpr std::size_t kFull = 400;

}  // namespace

PlaceIndex::PlaceIndex() {
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

std::uint32_t PlaceIndex::Key(int table, const Descriptor& descriptor) const {
    std::uint32_t key = static_cast<std::uint32_t>(table);
    for (const std::uint8_t bit : bits_[table])
        key = key << 1 | static_cast<std::uint32_t>(descriptor[bit / 64] >> (bit % 64) & 1);
    return key;
}

void PlaceIndex::Add(int keyframe, std::span<const Descriptor> descriptors) {
    TESSERA_CHECK(keyframe >= static_cast<int>(descriptors_.size()), "keyframe {} is not new",
                  keyframe);
    descriptors_.resize(static_cast<std::size_t>(keyframe) + 1);
    descriptors_.back().assign(descriptors.begin(), descriptors.end());
    for (std::size_t i = 0; i < descriptors.size(); ++i)
        for (int table = 0; table < kTables; ++table)
            buckets_[Key(table, descriptors[i])].push_back(
                {keyframe, static_cast<std::int32_t>(i)});
}

std::vector<PlaceIndex::Candidate> PlaceIndex::Query(std::span<const Descriptor> descriptors,
                                                     int end, int count, int min_votes) const {
    std::vector<int> votes(descriptors_.size(), 0), voted_by(descriptors_.size(), -1);
    for (std::size_t q = 0; q < descriptors.size(); ++q)
        for (int table = 0; table < kTables; ++table) {
            const auto bucket = buckets_.find(Key(table, descriptors[q]));
            if (bucket == buckets_.end() || bucket->second.size() > kFull) continue;
            for (const Entry& entry : bucket->second) {
                const auto keyframe = static_cast<std::size_t>(entry.keyframe);
                if (entry.keyframe >= end || voted_by[keyframe] == static_cast<int>(q)) continue;
                const Descriptor& other =
                    descriptors_[keyframe][static_cast<std::size_t>(entry.feature)];
                if (HammingDistance(descriptors[q], other) > kNear_bits) continue;
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
