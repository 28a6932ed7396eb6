#include "semantics/depth_segment.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "semantics/ring_planes.h"

namespace tessera {
namespace {

constexpr float kRing = 0.15f;  // ring width as a share of the longer box side
constexpr int kLeastRing_px = 8;
// The object is flat if less of the box than this lies off the planes.
constexpr float kFlatShare = 0.04f;
// A further piece belongs to the object if this share of it lies in the box.
constexpr float kInsideShare = 0.7f;
constexpr float kSameDepth_m = 0.03f;  // depth margin around the main piece, at least
constexpr float kDepthShare = 0.25f;   // and for large objects this share of the box width

PixelBox Grown(const PixelBox& box, const DepthImage& depth_m) {
    const int ring =
        std::max(kLeastRing_px,
                 static_cast<int>(kRing * static_cast<float>(std::max(box.width(), box.height()))));
    return {std::max(0, box.x_begin - ring), std::max(0, box.y_begin - ring),
            std::min(depth_m.width(), box.x_end + ring),
            std::min(depth_m.height(), box.y_end + ring)};
}

// Two neighbouring pixels lie on one surface if their depths differ by less than this. The limit
// leaves room for slanted surfaces.
bool Continuous(float a_m, float b_m) {
    const float z = std::min(a_m, b_m);
    return std::abs(a_m - b_m) < 0.008f + 0.006f * z * z;
}

struct Piece {
    int inside = 0, outside = 0;  // pixels in the box and around it
    std::vector<float> depths_m;  // of the pixels inside
};

// Connected pieces of the window's pixels that lie in no plane. Holds piece index + 1 for each
// pixel, 0 = none.
class Pieces {
  public:
    Pieces(const DepthImage& depth_m, const PinholeCamera& camera, const PixelBox& box,
           const PixelBox& window, std::span<const PixelBox> others)
        : depth_m_(depth_m),
          box_(box),
          window_(window),
          number_(window.width(), window.height(), 0),
          free_(window.width(), window.height(), 0) {
        const std::vector<Plane> planes = FindRingPlanes(depth_m, camera, box, window, others);
        for (int y = 0; y < window.height(); ++y)
            for (int x = 0; x < window.width(); ++x) free_(x, y) = IsFree(camera, planes, x, y);
        for (int y = 0; y < window.height(); ++y)
            for (int x = 0; x < window.width(); ++x)
                if (free_(x, y) != 0 && number_(x, y) == 0) Fill(x, y);
    }

    const std::vector<Piece>& pieces() const { return pieces_; }
    // (x, y) in image coordinates.
    int NumberAt(int x, int y) const { return number_(x - window_.x_begin, y - window_.y_begin); }
    int free_inside() const {
        int count = 0;
        for (const Piece& piece : pieces_) count += piece.inside;
        return count;
    }

  private:
    float DepthAt(int x, int y) const { return depth_m_(x + window_.x_begin, y + window_.y_begin); }

    bool IsFree(const PinholeCamera& camera, const std::vector<Plane>& planes, int x, int y) const {
        const float z = DepthAt(x, y);
        if (z <= 0) return false;
        const Eigen::Vector3f p =
            camera.Unproject(x + window_.x_begin, y + window_.y_begin, z).cast<float>();
        return std::ranges::none_of(planes, [&](const Plane& plane) {
            return std::abs(plane.n.dot(p) - plane.d) < PlaneTolerance_m(z);
        });
    }

    void Fill(int x, int y) {
        pieces_.emplace_back();
        Piece& piece = pieces_.back();
        const int number = static_cast<int>(pieces_.size());
        stack_.assign(1, {x, y});
        number_(x, y) = number;
        while (!stack_.empty()) {
            const auto [px, py] = stack_.back();
            stack_.pop_back();
            Count(px, py, piece);
            for (const auto& [nx, ny] :
                 {std::pair{px - 1, py}, {px + 1, py}, {px, py - 1}, {px, py + 1}}) {
                if (!number_.Contains(nx, ny) || free_(nx, ny) == 0 || number_(nx, ny) != 0)
                    continue;
                if (!Continuous(DepthAt(px, py), DepthAt(nx, ny))) continue;
                number_(nx, ny) = number;
                stack_.emplace_back(nx, ny);
            }
        }
    }

    void Count(int x, int y, Piece& piece) const {
        const int u = x + window_.x_begin, v = y + window_.y_begin;
        const bool inside =
            u >= box_.x_begin && u < box_.x_end && v >= box_.y_begin && v < box_.y_end;
        ++(inside ? piece.inside : piece.outside);
        if (inside) piece.depths_m.push_back(DepthAt(x, y));
    }

    const DepthImage& depth_m_;
    PixelBox box_, window_;
    Image<int> number_;
    Image<std::uint8_t> free_;
    std::vector<Piece> pieces_;
    std::vector<std::pair<int, int>> stack_;
};

float InsideShare(const Piece& piece) {
    return static_cast<float>(piece.inside) /
           static_cast<float>(std::max(1, piece.inside + piece.outside));
}

// Marks the pieces that belong to the object, by piece number.
std::vector<std::uint8_t> ChoosePieces(const std::vector<Piece>& pieces, float width_per_depth) {
    std::vector<std::uint8_t> chosen(pieces.size() + 1, 0);
    std::size_t main = 0;
    float best = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const float share = InsideShare(pieces[i]),
                    score = static_cast<float>(pieces[i].inside) * share * share;
        if (score > best) best = score, main = i;
    }
    if (best <= 0) return chosen;
    const float around_m =
        std::max(kSameDepth_m, kDepthShare * width_per_depth * Median(pieces[main].depths_m));
    const float near_m = Quantile(pieces[main].depths_m, 0.05) - around_m;
    const float far_m = Quantile(pieces[main].depths_m, 0.95) + around_m;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].inside == 0) continue;
        const float middle_m = Median(pieces[i].depths_m);
        chosen[i + 1] = i == main || (InsideShare(pieces[i]) >= kInsideShare && middle_m > near_m &&
                                      middle_m < far_m);
    }
    return chosen;
}

}  // namespace

void SegmentByMeanDepth(const DepthImage& depth_m, const PixelBox& box, Image<std::uint8_t>& mask) {
    mask.Resize(box.width(), box.height());
    double sum = 0;
    int count = 0;
    for (int y = box.y_begin; y < box.y_end; ++y)
        for (int x = box.x_begin; x < box.x_end; ++x)
            if (depth_m(x, y) > 0) sum += depth_m(x, y), ++count;
    const float mean = count > 0 ? static_cast<float>(sum / count) : 0.0f;
    for (int y = 0; y < box.height(); ++y)
        for (int x = 0; x < box.width(); ++x) {
            const float z = depth_m(x + box.x_begin, y + box.y_begin);
            mask(x, y) = z > 0 && z <= mean;
        }
}

void SegmentByDepth(const DepthImage& depth_m, const PinholeCamera& camera, const PixelBox& box,
                    std::span<const PixelBox> others, Image<std::uint8_t>& mask) {
    mask.Resize(box.width(), box.height());
    const Pieces pieces(depth_m, camera, box, Grown(box, depth_m), others);
    const bool flat = static_cast<float>(pieces.free_inside()) <
                      kFlatShare * static_cast<float>(box.width() * box.height());
    const std::vector<std::uint8_t> chosen =
        ChoosePieces(pieces.pieces(), static_cast<float>(box.width() / camera.fx));
    for (int y = 0; y < box.height(); ++y)
        for (int x = 0; x < box.width(); ++x) {
            const int u = x + box.x_begin, v = y + box.y_begin;
            mask(x, y) =
                flat ? depth_m(u, v) > 0 : chosen[static_cast<std::size_t>(pieces.NumberAt(u, v))];
        }
}

}  // namespace tessera
