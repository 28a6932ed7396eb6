#include "optimize/dense_view.h"

#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"
#include "optimize/bilinear.h"
#include "optimize/camera_view.h"

namespace tessera {
namespace {

// A cell whose depths differ by a larger share lies across a discontinuity.
constexpr float kCellSmooth = 0.04f;
constexpr float kGrazing = 0.2f;  // cosine between ray and normal

struct Cell {
    float sum = 0, nearest = 1e9f, farthest = 0, luma = 0;
    int known = 0, lit = 0;

    void Add(float z, float intensity) {
        if (z > 0) {
            sum += z;
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
            ++known;
        }
        if (intensity >= 0) {
            luma += intensity;
            ++lit;
        }
    }
    float depth_m(int least) const {
        return known >= least && farthest - nearest < kCellSmooth * nearest
                   ? sum / static_cast<float>(known)
                   : 0.0f;
    }
    float intensity() const { return lit > 0 ? luma / static_cast<float>(lit) : -1.0f; }
};

// The cell of n x n pixels at (x, y) of the reduced image. `intensity` may be empty.
Cell CellAt(const DepthImage& depth_m, const Image<float>& intensity, int n, int x, int y) {
    Cell cell;
    for (int j = n * y; j < n * y + n; ++j)
        for (int i = n * x; i < n * x + n; ++i)
            cell.Add(depth_m(i, j), intensity.empty() ? -1.0f : intensity(i, j));
    return cell;
}

// The pixel of the colour image that shows what `pixel` of the depth image measured at z, metres;
// 0: unknown, taken as far away. Colour and depth have their own time stamps, and a rolling shutter
// reads the rows one after another. To first order in time; the row's time is that of `pixel`.
Eigen::Vector2d ColourPixel(const PinholeCamera& camera, const FrameMotion& motion,
                            const Eigen::Vector2d& pixel, double z) {
    const double time_s =
        motion.ColourTime(pixel.y(), camera.height) - motion.DepthTime(pixel.y(), camera.height);
    const Eigen::Vector3d p = camera.Unproject(pixel.x(), pixel.y(), z > 0 ? z : 1.0);
    Eigen::Vector3d velocity = motion.twist_per_s.head<3>().cross(p);
    if (z > 0) velocity += motion.twist_per_s.tail<3>();
    const Eigen::Vector3d moved = p - time_s * velocity;
    return moved.z() > 0 ? camera.Project(moved) : pixel;
}

// Adds the intensities of the cell's surface. Returns false if it is not in the colour image.
bool AddColour(const Image<float>& intensity, const PinholeCamera& camera,
               const FrameMotion& motion, int n, int x, int y, Cell& cell) {
    const Eigen::Vector2d centre(n * x + 0.5 * (n - 1), n * y + 0.5 * (n - 1));
    const Eigen::Vector2d shift =
        ColourPixel(camera, motion, centre,
                    cell.known > 0 ? cell.sum / static_cast<float>(cell.known) : 0) -
        centre;
    const double left = n * x + shift.x(), top = n * y + shift.y();
    if (!(left >= 0 && top >= 0 && left + n < intensity.width() && top + n < intensity.height()))
        return false;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            cell.Add(0, static_cast<float>(SampleBilinear(intensity, left + i, top + j).value));
    return true;
}

DenseView::Level Halved(const DenseView::Level& fine) {
    DenseView::Level level;
    level.camera = Averaged(fine.camera, 2);
    level.depth_m.Resize(level.camera.width, level.camera.height);
    level.intensity.Resize(level.camera.width, level.camera.height);
    for (int y = 0; y < level.camera.height; ++y)
        for (int x = 0; x < level.camera.width; ++x) {
            const Cell cell = CellAt(fine.depth_m, fine.intensity, 2, x, y);
            level.depth_m(x, y) = cell.depth_m(2);
            level.intensity(x, y) = cell.intensity();
        }
    return level;
}

Eigen::Vector3f PointAt(const DenseView::Level& level, int x, int y) {
    return level.camera.Unproject(x, y, level.depth_m(x, y)).cast<float>();
}

// Normal of the plane through the four neighbours; zero at borders, discontinuities and grazing
// angles.
Eigen::Vector3f NormalAt(const DenseView::Level& level, int x, int y) {
    const DepthImage& d = level.depth_m;
    const float here = d(x, y), left = d(x - 1, y), right = d(x + 1, y), up = d(x, y - 1),
                down = d(x, y + 1);
    if (here <= 0 || left <= 0 || right <= 0 || up <= 0 || down <= 0)
        return Eigen::Vector3f::Zero();
    const float bend = 0.5f * kCellSmooth * here;
    if (std::abs(left + right - 2 * here) > bend || std::abs(up + down - 2 * here) > bend)
        return Eigen::Vector3f::Zero();
    const Eigen::Vector3f along = PointAt(level, x + 1, y) - PointAt(level, x - 1, y),
                          across = PointAt(level, x, y + 1) - PointAt(level, x, y - 1);
    const Eigen::Vector3f normal = across.cross(along).normalized();  // towards the camera
    return -normal.dot(PointAt(level, x, y).normalized()) > kGrazing ? normal
                                                                     : Eigen::Vector3f::Zero();
}

// `step`: every step-th cell in both directions becomes a point.
void FindPoints(DenseView::Level& level, int step) {
    level.normal.Resize(level.camera.width, level.camera.height);
    std::fill_n(level.normal.data(), level.normal.size(), Eigen::Vector3f::Zero());
    for (int y = 1; y + 1 < level.camera.height; ++y)
        for (int x = 1; x + 1 < level.camera.width; ++x) {
            const Eigen::Vector3f normal = NormalAt(level, x, y);
            level.normal(x, y) = normal;
            if (x % step == step / 2 && y % step == step / 2 && !normal.isZero())
                level.points.push_back({PointAt(level, x, y), normal, level.intensity(x, y),
                                        DepthSigma_m(level.depth_m(x, y))});
        }
}

}  // namespace

ReducedView MakeReducedView(const PreparedFrame& frame, const PinholeCamera& camera,
                            const FrameMotion& motion) {
    ReducedView view;
    const int n = std::max(1, (frame.width + ReducedView::kColumns / 2) / ReducedView::kColumns);
    view.reduction = n;
    view.depth.Resize(frame.width / n, frame.height / n);
    if (frame.has_colour) view.luma.Resize(view.depth.width(), view.depth.height());
    const bool moves = frame.has_colour && !motion.twist_per_s.isZero();
    const Image<float> none;
    for (int y = 0; y < view.depth.height(); ++y)
        for (int x = 0; x < view.depth.width(); ++x) {
            Cell cell = CellAt(frame.depth_m, moves ? none : frame.intensity, n, x, y);
            float units = cell.depth_m((n * n + 1) / 2) * ReducedView::kUnitsPerM;
            if (moves && !AddColour(frame.intensity, camera, motion, n, x, y, cell)) units = 0;
            view.depth(x, y) = static_cast<std::uint16_t>(units < 65535 ? std::lround(units) : 0);
            if (frame.has_colour)
                view.luma(x, y) = static_cast<std::uint8_t>(
                    std::clamp(std::lround(255 * cell.intensity()), 0L, 255L));
        }
    return view;
}

DenseView MakeDenseView(const ReducedView& view, const PinholeCamera& camera) {
    DenseView dense;
    DenseView::Level& finest = dense.levels.back();
    finest.camera = Averaged(camera, view.reduction);
    finest.depth_m.Resize(view.depth.width(), view.depth.height());
    finest.intensity.Resize(view.depth.width(), view.depth.height());
    for (std::size_t i = 0; i < view.depth.size(); ++i) {
        finest.depth_m.data()[i] =
            static_cast<float>(view.depth.data()[i]) / ReducedView::kUnitsPerM;
        finest.intensity.data()[i] =
            view.luma.empty() ? -1.0f : static_cast<float>(view.luma.data()[i]) / 255.0f;
    }
    for (const std::size_t coarse : {1, 0}) dense.levels[coarse] = Halved(dense.levels[coarse + 1]);
    FindPoints(dense.levels[0], 1);
    FindPoints(dense.levels[1], 1);
    FindPoints(dense.levels[2], 2);
    return dense;
}

}  // namespace tessera
