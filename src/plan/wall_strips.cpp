#include "plan/wall_strips.h"

#include <numbers>
#include <utility>

#include "plan/strip_openings.h"

namespace tessera {
namespace {

constexpr double kParallel = 0.9986;  // cosine of 3 degrees
constexpr double kThinnest_m = 0.03, kThickest_m = 0.6;

Eigen::Vector2d MiddleOf(const WallFace& face) {
    return face.line.At((face.along.low + face.along.high) / 2);
}

// Faces in one plane become one.
std::vector<WallFace> JoinFaces(std::vector<WallFace> faces, double noise_m) {
    std::vector<WallFace> joined;
    for (WallFace& face : faces) {
        const auto same = std::ranges::find_if(joined, [&](const WallFace& larger) {
            return larger.line.normal.dot(face.line.normal) > kParallel &&
                   std::abs(larger.line.Distance(MiddleOf(face))) < 3 * noise_m;
        });
        if (same == joined.end()) {
            joined.push_back(std::move(face));
            continue;
        }
        const double share = face.area_m2 / (same->area_m2 + face.area_m2);
        same->line.offset_m += share * same->line.Distance(MiddleOf(face));
        same->rms_m =
            std::sqrt((1 - share) * same->rms_m * same->rms_m + share * face.rms_m * face.rms_m);
        same->area_m2 += face.area_m2;
        same->along = {std::min(same->along.low, face.along.low),
                       std::max(same->along.high, face.along.high)};
        same->members.insert(same->members.end(), face.members.begin(), face.members.end());
    }
    return joined;
}

// How thick a wall with these faces would be; nothing if they are not one wall.
std::optional<double> Thickness(const WallFace& front, const WallFace& back) {
    if (front.line.normal.dot(back.line.normal) > -kParallel) return std::nullopt;
    const Interval along{-back.along.high, -back.along.low};  // the other way round
    const double least_m = std::min(0.3, 0.5 * std::min(along.Length(), front.along.Length()));
    if (front.along.Overlap(along) < least_m) return std::nullopt;
    const double middle =
        (std::max(along.low, front.along.low) + std::min(along.high, front.along.high)) / 2;
    const double thickness_m = -front.line.Distance(back.line.At(-middle));
    if (thickness_m < kThinnest_m || thickness_m > kThickest_m) return std::nullopt;
    return thickness_m;
}

// The sides of an opening, as deep as the wall is thick, belong to that wall.
bool IsReveal(const WallStrip& strip, const std::vector<WallStrip>& strips) {
    constexpr double kSquare = 0.2, kSlack_m = 0.1;
    if (strip.thickness_m > 0) return false;
    const Eigen::Vector2d begin = strip.front.At(strip.solid.front().low),
                          end = strip.front.At(strip.solid.back().high);
    return std::ranges::any_of(strips, [&](const WallStrip& wall) {
        const double low = std::min(wall.front.Distance(begin), wall.front.Distance(end)),
                     high = std::max(wall.front.Distance(begin), wall.front.Distance(end));
        return wall.thickness_m > 0 &&
               std::abs(wall.front.normal.dot(strip.front.normal)) < kSquare && high < kSlack_m &&
               low > -wall.thickness_m - kSlack_m;
    });
}

}  // namespace

std::vector<WallStrip> FindWallStrips(const PlanEvidence& evidence, std::vector<WallFace> faces,
                                      double noise_m) {
    faces = JoinFaces(std::move(faces), noise_m);
    std::vector<bool> used(faces.size());
    std::vector<WallStrip> strips;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (used[i]) continue;
        WallStrip strip;
        strip.front = faces[i].line;
        std::size_t back = i;
        for (std::size_t k = i + 1; k < faces.size(); ++k)
            if (const std::optional<double> thickness_m = Thickness(faces[i], faces[k]);
                !used[k] && thickness_m && (back == i || *thickness_m < strip.thickness_m)) {
                back = k;
                strip.thickness_m = *thickness_m;
            }
        strip.rms_m = std::max(faces[i].rms_m, faces[back].rms_m);
        strip.area_m2 = faces[i].area_m2 + (back == i ? 0 : faces[back].area_m2);
        strip.front_members = std::move(faces[i].members);
        if (back != i) strip.back_members = std::move(faces[back].members);
        used[i] = used[back] = true;
        FindSolid(evidence, strip);
        if (!strip.solid.empty()) strips.push_back(std::move(strip));
    }
    const std::vector<WallStrip> all = strips;
    std::erase_if(strips, [&](const WallStrip& strip) { return IsReveal(strip, all); });
    JoinCorners(evidence, strips);
    return strips;
}

}  // namespace tessera
