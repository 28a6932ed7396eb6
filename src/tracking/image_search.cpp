#include "tracking/image_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {
namespace {

// 1.75 degrees each, 16 in all, at 40 x 30 and a Kinect's focal length
constexpr int kReach_px = 9;
constexpr int kShifts = 2 * kReach_px + 1;
constexpr std::array<double, 3> kRolls_rad = {0.0, -0.1, 0.1};
constexpr double kLeastOverlap = 0.4;

// The image rotated about the optical axis by `roll_rad`; -1 where nothing lands.
Image<float> Roll(const Image<float>& image, const PinholeCamera& camera, double roll_rad) {
    if (roll_rad == 0) return image;
    Image<float> out(image.width(), image.height(), -1.0f);
    const double c = std::cos(roll_rad), s = std::sin(roll_rad);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double dx = x - camera.cx, dy = y - camera.cy;
            const double u = c * dx + s * dy + camera.cx, v = -s * dx + c * dy + camera.cy;
            if (u < 0 || v < 0 || u >= image.width() - 1 || v >= image.height() - 1) continue;
            const int iu = static_cast<int>(u), iv = static_cast<int>(v);
            const auto fu = static_cast<float>(u - iu), fv = static_cast<float>(v - iv);
            const float top = image(iu, iv) + fu * (image(iu + 1, iv) - image(iu, iv));
            const float bottom =
                image(iu, iv + 1) + fu * (image(iu + 1, iv + 1) - image(iu, iv + 1));
            out(x, y) = top + fv * (bottom - top);
        }
    return out;
}

// Variance of current(x + dx, y + dy) - last(x, y). The mean, a change of exposure, drops out.
double DifferenceVariance(const Image<float>& last, const Image<float>& current, int dx, int dy) {
    float sum = 0, sum2 = 0, n = 0;
    for (int y = std::max(0, -dy); y < last.height() + std::min(0, -dy); ++y) {
        const float* a = last.row(y);
        const float* b = current.row(y + dy) + dx;
        for (int x = std::max(0, -dx); x < last.width() + std::min(0, -dx); ++x) {
            const float known = a[x] >= 0 && b[x] >= 0 ? 1.0f : 0.0f;
            const float d = known * (b[x] - a[x]);
            sum += d;
            sum2 += d * d;
            n += known;
        }
    }
    if (n < kLeastOverlap * static_cast<double>(last.size())) return 1e9;
    const float mean = sum / n;
    return sum2 / n - mean * mean;
}

}  // namespace

std::vector<Eigen::Vector3d> SearchRotations(const Image<float>& last, const Image<float>& current,
                                             const PinholeCamera& camera, int count) {
    struct Candidate {
        double variance;
        int roll, dx, dy;
    };
    std::vector<Candidate> all(kRolls_rad.size() * kShifts * kShifts);
    std::vector<Image<float>> rolled;
    for (const double roll : kRolls_rad) rolled.push_back(Roll(last, camera, roll));
    tbb::parallel_for(0, static_cast<int>(kRolls_rad.size()) * kShifts, [&](int task) {
        const int roll = task / kShifts, dy = task % kShifts - kReach_px;
        for (int dx = -kReach_px; dx <= kReach_px; ++dx)
            all[static_cast<std::size_t>(task * kShifts + dx + kReach_px)] = {
                DifferenceVariance(rolled[static_cast<std::size_t>(roll)], current, dx, dy), roll,
                dx, dy};
    });
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return a.variance < b.variance;
    });
    std::vector<Candidate> best;
    for (const Candidate& c : all) {
        if (c.variance >= 1e9 || static_cast<int>(best.size()) >= count) break;
        const bool near_better = std::any_of(best.begin(), best.end(), [&](const Candidate& b) {
            return std::abs(b.dx - c.dx) <= 1 && std::abs(b.dy - c.dy) <= 1;
        });
        if (!near_better) best.push_back(c);
    }
    std::vector<Eigen::Vector3d> rotations;
    for (const Candidate& c : best)  // a rotation by +y moves the image right, by +x up
        rotations.emplace_back(-c.dy / camera.fy, c.dx / camera.fx,
                               kRolls_rad[static_cast<std::size_t>(c.roll)]);
    return rotations;
}

}  // namespace tessera
