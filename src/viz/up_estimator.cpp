#include "viz/up_estimator.h"

#include <cmath>

namespace tessera {
namespace {

constexpr float kCosReach = 0.602f, kSinReach = 0.799f;  // cosine and sine of 53 degrees
constexpr double kLeastNormals = 500, kLeastShare = 0.08;

Eigen::Vector3f FromOctahedral(const std::array<std::int16_t, 2>& packed) {
    const float x = static_cast<float>(packed[0]) / 32767,
                y = static_cast<float>(packed[1]) / 32767;
    const float z = 1 - std::abs(x) - std::abs(y);
    if (z >= 0) return Eigen::Vector3f(x, y, z).normalized();
    return Eigen::Vector3f((1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f),
                           (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f), z)
        .normalized();
}

}  // namespace

UpEstimator::UpEstimator(const Eigen::Vector3d& roughly_up)
    : rough_(roughly_up.normalized().cast<float>()) {
    const Eigen::Vector3f any =
        std::abs(rough_.z()) < 0.9f ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
    east_ = any.cross(rough_).normalized();
    north_ = rough_.cross(east_);
}

void UpEstimator::Add(const BlockGeometry& geometry) {
    // A few samples per block are enough to find a direction.
    for (std::size_t i = 0; i < geometry.vertices.size(); i += 8)
        Add(FromOctahedral(geometry.vertices[i].normal));
}

void UpEstimator::Add(const Eigen::Vector3f& normal_world) {
    count_ += 1;
    if (normal_world.dot(rough_) < kCosReach) return;
    const auto bin = [&](const Eigen::Vector3f& axis) {
        const float unit = 0.5f + 0.5f * normal_world.dot(axis) / kSinReach;
        return std::min(std::max(static_cast<int>(unit * kBins), 0), kBins - 1);
    };
    Bin& found = bins_[static_cast<std::size_t>(bin(north_) * kBins + bin(east_))];
    found.sum += normal_world.cast<double>();
    found.count += 1;
}

std::optional<Eigen::Vector3d> UpEstimator::Up() const {
    // If the rough direction is off by 45 degrees, a wall is as close to it as the floor, so nearer
    // directions count more.
    const auto weight = [&](const Bin& bin) {
        return bin.count * std::pow(bin.sum.normalized().dot(rough_.cast<double>()), 4);
    };
    Bin best;
    double most = 0;
    for (int y = 1; y < kBins - 1; ++y)
        for (int x = 1; x < kBins - 1; ++x) {
            Bin around;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    around.sum += At(x + dx, y + dy).sum;
                    around.count += At(x + dx, y + dy).count;
                }
            if (around.count == 0 || weight(around) <= most) continue;
            most = weight(around);
            best = around;
        }
    if (count_ < kLeastNormals || best.count < kLeastShare * count_) return std::nullopt;
    return best.sum.normalized();
}

}  // namespace tessera
