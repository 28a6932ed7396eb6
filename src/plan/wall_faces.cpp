#include "plan/wall_faces.h"

#include <numbers>

#include "plan/wall_columns.h"
#include "plan/wall_sweeps.h"

namespace tessera {
namespace {

constexpr int kMostAttempts = 400;  // bounds the time that a hostile mesh can take
constexpr double kMostTurn = 3 * std::numbers::pi / 180;  // a fit from the direction of its peak
constexpr double kBands = 4;       // half the width of a face, in standard deviations
constexpr double kRunGap_m = 1.5;  // one wall may have doorways

// Least squares through the points within `band_m` of the line, twice.
PlanLine Fit(const PlanEvidence& evidence, const PlanLine& start,
             const std::vector<std::uint32_t>& points, double band_m) {
    PlanLine line = start;
    for (int round = 0; round < 2; ++round) {
        double n = 0, t = 0, d = 0, tt = 0, td = 0;
        for (const std::uint32_t i : points) {
            const Eigen::Vector2d p = evidence.upright[i].position.cast<double>();
            const double off = line.Distance(p), along = line.Along(p);
            if (std::abs(off) > band_m) continue;
            n += 1, t += along, d += off, tt += along * along, td += along * off;
        }
        if (n < 10) return line;
        const double spread = tt / n - t * t / (n * n);
        const double slope = spread < 0.05 * 0.05 ? 0 : (td / n - t * d / (n * n)) / spread;
        const Eigen::Vector2d through = line.At(t / n) + d / n * line.normal;
        const Eigen::Vector2d normal = (line.normal - slope * line.Direction()).normalized();
        if (normal.dot(start.normal) < std::cos(kMostTurn)) return line;
        line = {normal, normal.dot(through)};
    }
    return line;
}

// The points within `band_m` of the line, in runs without a gap of kRunGap_m.
std::vector<std::vector<std::uint32_t>> RunsOf(const PlanEvidence& evidence, const PlanLine& line,
                                               const std::vector<std::uint32_t>& points,
                                               double band_m) {
    std::vector<std::pair<double, std::uint32_t>> along;
    for (const std::uint32_t i : points) {
        const Eigen::Vector2d p = evidence.upright[i].position.cast<double>();
        if (std::abs(line.Distance(p)) <= band_m) along.emplace_back(line.Along(p), i);
    }
    std::ranges::sort(along);
    std::vector<std::vector<std::uint32_t>> runs;
    for (std::size_t i = 0; i < along.size(); ++i) {
        if (i == 0 || along[i].first - along[i - 1].first > kRunGap_m) runs.emplace_back();
        runs.back().push_back(along[i].second);
    }
    return runs;
}

void Measure(const PlanEvidence& evidence, WallFace& face) {
    double squares = 0;
    face.along = {HUGE_VAL, -HUGE_VAL};
    for (const std::uint32_t i : face.members) {
        const Eigen::Vector2d p = evidence.upright[i].position.cast<double>();
        squares += std::pow(face.line.Distance(p), 2);
        face.along.low = std::min(face.along.low, face.line.Along(p));
        face.along.high = std::max(face.along.high, face.line.Along(p));
    }
    const auto count = static_cast<double>(face.members.size());
    face.rms_m = std::sqrt(squares / count);
    face.area_m2 = count * evidence.spacing_m * evidence.spacing_m;
}

// Walls reach higher than furniture, over a good part of their length.
bool IsWall(const PlanEvidence& evidence, const WallFace& face, const WallFaceOptions& options) {
    constexpr double kHighShare = 0.35;
    const ColumnReader reader(evidence);
    const WallColumns columns = ColumnsOf(evidence, face.line, face.members);
    double wall_m = 0, high_m = 0;
    for (const HeightBits bits : columns.bits) {
        if (reader.High(bits)) high_m += columns.width_m;
        if (reader.High(bits) || reader.Solid(bits)) wall_m += columns.width_m;
    }
    return wall_m >= options.least_length_m && face.area_m2 >= options.least_area_m2 &&
           high_m >= kHighShare * wall_m;
}

// Standard deviation of a face's direction if its errors are one smooth bend, radians: errors of a
// map are.
double AngleError(const WallFace& face) {
    return std::sqrt(12.0) * face.rms_m / std::max(face.along.Length(), 0.01);
}

// Turns faces, largest first, into the direction (modulo a right angle) of larger ones from which
// they do not differ by more than the errors.
void Snap(const PlanEvidence& evidence, std::vector<WallFace>& faces) {
    constexpr double kQuarter = std::numbers::pi / 2;
    struct Group {
        double angle = 0, weight = 0, error = 0;
    };
    const auto off = [](const WallFace& face, double angle) {
        return std::remainder(std::atan2(face.line.normal.y(), face.line.normal.x()) - angle,
                              kQuarter);
    };
    std::vector<Group> groups;
    std::vector<std::size_t> group_of(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const double weight = std::pow(faces[i].along.Length(), 2) * faces[i].area_m2;
        std::size_t g = 0;
        while (g < groups.size() && std::abs(off(faces[i], groups[g].angle)) >
                                        2 * std::hypot(AngleError(faces[i]), groups[g].error))
            ++g;
        if (g == groups.size())
            groups.push_back({std::atan2(faces[i].line.normal.y(), faces[i].line.normal.x()), 0,
                              AngleError(faces[i])});
        groups[g].weight += weight;
        groups[g].angle += off(faces[i], groups[g].angle) * weight / groups[g].weight;
        group_of[i] = g;
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        PlanLine& line = faces[i].line;
        Eigen::Vector2d mean = Eigen::Vector2d::Zero();
        for (const std::uint32_t k : faces[i].members)
            mean += evidence.upright[k].position.cast<double>();
        mean /= static_cast<double>(faces[i].members.size());
        const double angle =
            std::atan2(line.normal.y(), line.normal.x()) - off(faces[i], groups[group_of[i]].angle);
        line.normal = {std::cos(angle), std::sin(angle)};
        line.offset_m = line.normal.dot(mean);
        Measure(evidence, faces[i]);
    }
}

// A noisy or drifted wall has weak copies close to itself; pictures and pilasters look like them.
// One that faces the wall is no surface at all: nobody could look from there.
bool IsCopy(const WallFace& face, const WallFace& larger) {
    constexpr double kParallel = 0.9945, kClose_m = 0.15;
    const double facing = face.line.normal.dot(larger.line.normal);
    if (std::abs(facing) < kParallel || face.area_m2 > 0.3 * larger.area_m2) return false;
    const double off_m = larger.line.Distance(face.line.At((face.along.low + face.along.high) / 2));
    const Interval along = facing > 0 ? face.along : Interval{-face.along.high, -face.along.low};
    return larger.along.Overlap(along) > 0.5 * along.Length() && std::abs(off_m) < kClose_m &&
           (facing > 0 || off_m > 0);
}

}  // namespace

std::vector<WallFace> FindWallFaces(const PlanEvidence& evidence, const WallFaceOptions& options) {
    const double band_m = kBands * options.noise_m;
    WallSweeps sweeps(evidence);
    std::vector<WallFace> faces;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
        const WallSweeps::Peak peak = sweeps.Largest();
        if (peak.area_m2 < options.least_area_m2 / 2 || peak.area_m2 <= 0) break;
        const std::vector<std::uint32_t> near = sweeps.Near(peak, 0.3);
        const PlanLine line = Fit(evidence, peak.line, near, band_m);
        for (const auto& run : RunsOf(evidence, line, near, 2 * band_m)) {
            WallFace face;
            face.line = Fit(evidence, line, run, band_m);
            for (const std::uint32_t i : run)
                if (std::abs(face.line.Distance(evidence.upright[i].position.cast<double>())) <=
                    band_m)
                    face.members.push_back(i);
            if (face.members.empty()) continue;
            Measure(evidence, face);
            if (face.along.Length() < options.least_length_m) continue;
            sweeps.Take(face.members);
            if (IsWall(evidence, face, options)) faces.push_back(std::move(face));
        }
        sweeps.TakePeak(peak);
    }
    std::ranges::stable_sort(faces, std::greater<>(), &WallFace::area_m2);
    Snap(evidence, faces);
    std::vector<WallFace> kept;
    for (WallFace& face : faces)
        if (std::ranges::none_of(kept,
                                 [&](const WallFace& larger) { return IsCopy(face, larger); }))
            kept.push_back(std::move(face));
    return kept;
}

}  // namespace tessera
