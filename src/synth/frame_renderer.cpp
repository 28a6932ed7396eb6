#include "synth/frame_renderer.h"

#include <oneapi/tbb/blocked_range2d.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/row_time.h"

namespace tessera {
namespace {

constexpr int kTile = 16;  // pixels
constexpr int kSamples = 4;
// Rotated grid: no two samples share a column or a row.
constexpr double kOffsets[kSamples][2] = {
    {-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}};
// Filter extent of one sample; slightly more than its share of the pixel, against moire.
constexpr float kSampleExtentPx = 0.7f;

using TileHits = std::array<SurfaceHit, kTile * kTile>;

class TileRenderer {
  public:
    TileRenderer(const Scene& scene, const PinholeCamera& camera, double time_s, RenderedView& view)
        : scene_(scene),
          pixel_m_(static_cast<float>(kSampleExtentPx / camera.fx)),
          time_s_(time_s),
          view_(view) {}

    void AddColour(const ViewCaster& caster, const PixelRect& rect, int sample) const {
        TileHits hits;
        Cast(caster, rect, kOffsets[sample][0], kOffsets[sample][1], hits);
        std::size_t i = 0;
        for (int y = rect.y_begin; y < rect.y_end; ++y) {
            for (int x = rect.x_begin; x < rect.x_end; ++x, ++i) {
                if (!hits[i].valid()) continue;
                const float stretch = 1.0f / std::sqrt(std::max(hits[i].cos_incidence, 0.05f));
                const RgbF c =
                    scene_.Colour(hits[i], static_cast<float>(hits[i].t) * pixel_m_ * stretch);
                RgbF& sum = view_.colour(x, y);
                sum = {sum.r + c.r / kSamples, sum.g + c.g / kSamples, sum.b + c.b / kSamples};
            }
        }
    }

    void FillTruth(const ViewCaster& caster, const PixelRect& rect) const {
        TileHits hits;
        Cast(caster, rect, 0, 0, hits);
        std::size_t i = 0;
        for (int y = rect.y_begin; y < rect.y_end; ++y) {
            for (int x = rect.x_begin; x < rect.x_end; ++x, ++i) {
                const SurfaceHit& hit = hits[i];
                const int instance = hit.valid() ? scene_.InstanceOf(hit) : 0;
                view_.depth_m(x, y) = hit.valid() ? static_cast<float>(hit.t) : 0.0f;
                view_.cos_incidence(x, y) = hit.cos_incidence;
                view_.instance(x, y) = static_cast<std::uint16_t>(instance);
                view_.class_id(x, y) =
                    static_cast<std::uint16_t>(scene_.instances()[instance].class_id);
                view_.mobility(x, y) =
                    hit.valid() ? scene_.MobilityOf(hit, time_s_) : Mobility::kStatic;
                if (!view_.patch.empty())
                    view_.patch(x, y) = hit.valid() ? scene_.PatchOf(hit) : -1;
            }
        }
    }

  private:
    static void Cast(const ViewCaster& caster, const PixelRect& rect, double x, double y,
                     TileHits& hits) {
        const auto count = static_cast<std::size_t>(rect.width() * rect.height());
        caster.Cast(rect, x, y, std::span(hits).first(count));
    }

    const Scene& scene_;
    float pixel_m_;  // extent of a sample at 1 m
    double time_s_;
    RenderedView& view_;
};

void Resize(RenderedView& view, int width, int height, bool with_patches) {
    view.colour = Image<RgbF>(width, height);
    view.depth_m.Resize(width, height);
    view.cos_incidence.Resize(width, height);
    view.class_id.Resize(width, height);
    view.instance.Resize(width, height);
    view.mobility.Resize(width, height);
    view.patch.Resize(with_patches ? width : 0, with_patches ? height : 0);
}

}  // namespace

void FrameRenderer::RenderBand(const CameraPath& path, double time_s, double exposure_s,
                               int first_row, int last_row, RenderedView& view) const {
    const double middle = 0.5 * (first_row + last_row - 1);
    const double depth_s = time_s + RowTime(rig_.depth_readout_s, middle, camera_.height);
    const double colour_s =
        time_s + rig_.colour_delay_s + RowTime(rig_.colour_readout_s, middle, camera_.height);
    const Eigen::Isometry3d T_depth_colour = rig_.T_depth_colour();
    const auto truth = scene_.View(camera_, path.T_world_camera(depth_s), depth_s);
    std::array<std::unique_ptr<ViewCaster>, kSamples> moments;
    for (int i = 0; i < kSamples; ++i) {
        const double share = (i + 0.5) / kSamples - 0.5;
        const double moment_s = colour_s + share * exposure_s;
        moments[i] = scene_.View(camera_, path.T_world_camera(moment_s) * T_depth_colour, moment_s);
    }
    const TileRenderer tile(scene_, camera_, depth_s, view);
    const int columns = (camera_.width + kTile - 1) / kTile,
              rows = (last_row - first_row + kTile - 1) / kTile;
    tbb::parallel_for(tbb::blocked_range2d<int>(0, rows, 0, columns), [&](const auto& range) {
        for (int row = range.rows().begin(); row < range.rows().end(); ++row) {
            for (int column = range.cols().begin(); column < range.cols().end(); ++column) {
                const PixelRect rect{column * kTile, first_row + row * kTile,
                                     std::min((column + 1) * kTile, camera_.width),
                                     std::min(first_row + (row + 1) * kTile, last_row)};
                for (int i = 0; i < kSamples; ++i) tile.AddColour(*moments[i], rect, i);
                tile.FillTruth(*truth, rect);
            }
        }
    });
}

void FrameRenderer::Render(const CameraPath& path, double time_s, double exposure_s,
                           RenderedView& view, bool with_patches) const {
    Resize(view, camera_.width, camera_.height, with_patches);
    const bool rolling = rig_.depth_readout_s != 0 || rig_.colour_readout_s != 0;
    const int step = rolling ? kRowsAtOnce : camera_.height;
    tbb::parallel_for(0, (camera_.height + step - 1) / step, [&](int band) {
        RenderBand(path, time_s, exposure_s, band * step,
                   std::min((band + 1) * step, camera_.height), view);
    });
}

Eigen::Isometry3d CameraRig::T_depth_colour() const {
    const double turn_rad = colour_turn_deg * std::numbers::pi / 180;
    return Eigen::Translation3d(colour_x_m, 0, 0) *
           Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY());
}

void CameraRig::Describe(ConfigParameters& p) {
    p.Add("depth_readout_s", depth_readout_s, {-0.1, 0.1}, "s",
          "read-out time of the depth image's rolling shutter, from the first row to the last");
    p.Add("colour_readout_s", colour_readout_s, {-0.1, 0.1}, "s",
          "read-out time of the colour image's rolling shutter");
    p.Add("colour_delay_s", colour_delay_s, {-0.1, 0.1}, "s",
          "delay of the colour exposure after its time stamp");
    p.Add("colour_x_m", colour_x_m, {-0.2, 0.2}, "m",
          "offset of the colour camera to the right of the camera to which the depth image is "
          "registered");
    p.Add("colour_turn_deg", colour_turn_deg, {-10, 10}, "deg",
          "rotation of the colour camera to the right");
    p.Add("depth_scale", depth_scale, {0.5, 2}, "", "ratio of measured to true depth");
}

}  // namespace tessera
