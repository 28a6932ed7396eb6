#include "optimize/warp_block.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Along one axis: between which two of the three blocks' centres a voxel lies.
struct BetweenBlocks {
    explicit BetweenBlocks(int voxel) {
        const float at = (static_cast<float>(voxel) - 0.5f * (kBlockSide - 1)) / kBlockSide;
        first = at < 0 ? 0 : 1;
        part = at < 0 ? at + 1 : at;
    }
    int first;
    float part;
};

template <class T>
T Lerp(const T& a, const T& b, float part) {
    return a + part * (b - a);
}

// `value` is not negative.
std::uint32_t Rounded(float value) { return static_cast<std::uint32_t>(value + 0.5f); }

// Of the four samples around a place between the second and the third (Catmull and Rom).
Eigen::Array4f CubicWeights(float t) {
    return {t * (t * (1 - 0.5f * t) - 0.5f), t * t * (1.5f * t - 2.5f) + 1,
            t * (t * (2 - 1.5f * t) + 0.5f), t * t * (0.5f * t - 0.5f)};
}

}  // namespace

void BlockWarper::Warp(const BlockCoord& c, const ShiftsAround& shifts, WarpedBlock& block) {
    block.known = false;
    if (map_.has_labels()) block.label.fill({});
    if (!Load(c, shifts)) return;
    block.field.fill(kUnknownField);
    block.weight.fill(0);
    block.colour.fill(kNoColour);
    std::size_t at = 0;
    for (int z = 0; z < kBlockSide; ++z)
        for (int y = 0; y < kBlockSide; ++y) {
            const BetweenBlocks in_y(y), in_z(z);
            Eigen::Vector3f row[3];  // at the centres of the blocks along x
            for (int x = 0; x < 3; ++x) {
                const auto shift = [&](int dy, int dz) -> const Eigen::Vector3f& {
                    return shifts[static_cast<std::size_t>(x + 3 * (in_y.first + dy) +
                                                           9 * (in_z.first + dz))];
                };
                row[x] = Lerp<Eigen::Vector3f>(
                    Lerp<Eigen::Vector3f>(shift(0, 0), shift(1, 0), in_y.part),
                    Lerp<Eigen::Vector3f>(shift(0, 1), shift(1, 1), in_y.part), in_z.part);
            }
            for (int x = 0; x < kBlockSide; ++x, ++at) {
                const BetweenBlocks in_x(x);
                // Rounding must not leave what was loaded.
                const Eigen::Vector3f p =
                    (Eigen::Vector3i(x, y, z).cast<float>() -
                     Lerp<Eigen::Vector3f>(row[in_x.first], row[in_x.first + 1], in_x.part))
                        .cwiseMax(low_)
                        .cwiseMin(high_);
                const Parts v = Interpolate(p);
                if (v[kKnown] < 0.5f) continue;
                block.known = true;
                if (!labels_.empty()) block.label[at] = Nearest(p);
                const float distance = v[kDistance] / v[kKnown];
                const std::uint32_t steps = Rounded(kDistanceSteps * std::abs(distance));
                block.field[at] = (distance < 0 ? 0u - steps : steps) << 16;
                block.weight[at] = static_cast<std::uint16_t>(Rounded(v[kWeight] / v[kKnown]));
                if (v[kLit] <= 0) continue;
                Eigen::Array4f colour = v.tail<4>() / v[kLit];
                if (std::abs(distance) < near_) InterpolateColour(p, colour);
                block.field[at] |= 1u + Rounded(kIntensitySteps * colour[0]);
                block.colour[at] =
                    Rounded(colour[1]) | Rounded(colour[2]) << 10 | Rounded(colour[3]) << 20;
            }
        }
}

// Copies the voxels that may be needed. Returns false if there are none.
bool BlockWarper::Load(const BlockCoord& c, const ShiftsAround& shifts) {
    Eigen::Vector3f least = shifts[0], most = shifts[0];
    for (const Eigen::Vector3f& shift : shifts) {
        least = least.cwiseMin(shift);
        most = most.cwiseMax(shift);
    }
    low_ = -most;
    high_ = (kBlockSide - 1) - least.array();
    first_ = low_.array().floor().cast<int>() - 1;
    size_ = high_.array().floor().cast<int>() - first_.array() + 3;
    voxels_.assign(static_cast<std::size_t>(size_.prod()), Parts::Zero());
    labels_.assign(map_.has_labels() ? voxels_.size() : 0, {});
    const Eigen::Vector3i last = first_ + size_ - Eigen::Vector3i::Ones();
    bool any = false;
    for (int z = first_.z() >> 3; z <= last.z() >> 3; ++z)
        for (int y = first_.y() >> 3; y <= last.y() >> 3; ++y)
            for (int x = first_.x() >> 3; x <= last.x() >> 3; ++x) {
                const BlockId id = map_.Find({c.x + x, c.y + y, c.z + z});
                if (id == kUnknownBlock) continue;
                any = true;
                LoadBlock(id, kBlockSide * Eigen::Vector3i(x, y, z));
            }
    return any;
}

// `corner`: of the block's first voxel, like first_.
void BlockWarper::LoadBlock(BlockId id, const Eigen::Vector3i& corner) {
    const Eigen::Vector3i low = first_.cwiseMax(corner) - corner,
                          high = (first_ + size_)
                                     .cwiseMin(corner + Eigen::Vector3i::Constant(kBlockSide)) -
                                 corner;
    const Eigen::Vector3i at = corner - first_;
    for (int z = low.z(); z < high.z(); ++z)
        for (int y = low.y(); y < high.y(); ++y) {
            const std::ptrdiff_t row = kBlockSide * (y + kBlockSide * z);
            const FieldWord* field = map_.field(id) + row;
            const std::uint16_t* weight = map_.weight(id) + row;
            const ColourWord* colour = map_.colour(id) + row;
            const int first = at.x() + size_.x() * (at.y() + y + size_.y() * (at.z() + z));
            if (!labels_.empty())
                std::copy(map_.label(id) + row + low.x(), map_.label(id) + row + high.x(),
                          labels_.begin() + first + low.x());
            Parts* parts = voxels_.data() + first;
            for (int x = low.x(); x < high.x(); ++x) {
                if (!HasDistance(field[x])) continue;
                Parts& p = parts[x];
                p.head<4>() << 1, FieldDistance(field[x]), static_cast<float>(weight[x]), 0;
                if (!HasIntensity(field[x])) continue;
                p[kLit] = 1;
                p.tail<4>() << FieldIntensity(field[x]), static_cast<float>(colour[x] & 1023u),
                    static_cast<float>(colour[x] >> 10 & 1023u),
                    static_cast<float>(colour[x] >> 20);
            }
        }
}

// Intensity and chroma from 64 voxels. Leaves them as they are, and the weight, if one of these has
// none.
void BlockWarper::InterpolateColour(const Eigen::Vector3f& p, Eigen::Array4f& colour) const {
    const Eigen::Vector3f low = p.array().floor(), part = p - low;
    const Eigen::Array4f in_x = CubicWeights(part.x()), in_y = CubicWeights(part.y()),
                         in_z = CubicWeights(part.z());
    const Eigen::Vector3i at = low.cast<int>() - first_ - Eigen::Vector3i::Ones();
    Eigen::Array4f sum = Eigen::Array4f::Zero();
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y) {
            const Parts* v =
                voxels_.data() + at.x() + size_.x() * (at.y() + y + size_.y() * (at.z() + z));
            Eigen::Array4f along = Eigen::Array4f::Zero();
            for (int x = 0; x < 4; ++x) {
                if (v[x][kLit] == 0) return;
                along += in_x[x] * v[x].tail<4>();
            }
            sum += in_y[y] * in_z[z] * along;
        }
    colour[0] = std::clamp(sum[0], 0.0f, 1.0f);
    colour[1] = std::clamp(sum[1], 0.0f, kChromaSteps);
    colour[2] = std::clamp(sum[2], 0.0f, kChromaSteps);
}

VoxelLabel BlockWarper::Nearest(const Eigen::Vector3f& p) const {
    const Eigen::Vector3i at = p.array().round().cast<int>() - first_.array();
    return labels_[static_cast<std::size_t>(at.x() + size_.x() * (at.y() + size_.y() * at.z()))];
}

// Trilinearly. `p`, here and above, is relative to the block's first voxel.
BlockWarper::Parts BlockWarper::Interpolate(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f low = p.array().floor(), part = p - low;
    const Eigen::Vector3i at = low.cast<int>() - first_;
    const int along_y = size_.x(), along_z = along_y * size_.y();
    const Parts* v = voxels_.data() + at.x() + along_y * at.y() + along_z * at.z();
    const auto along_x = [&](const Parts* from) -> Parts {
        return Lerp<Parts>(from[0], from[1], part.x());
    };
    const Parts near = Lerp<Parts>(along_x(v), along_x(v + along_y), part.y()),
                far = Lerp<Parts>(along_x(v + along_z), along_x(v + along_z + along_y), part.y());
    return Lerp<Parts>(near, far, part.z());
}

}  // namespace tessera
