#include "run/first_seconds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/brightening.h"
#include "io/frame_reader.h"
#include "optimize/camera_estimator.h"

namespace tessera {
namespace {

constexpr double kWindow_s = 8, kEvery_s = 0.1, kShortest_s = 0.06;
constexpr int kLeastViews = 12;
constexpr std::int64_t kMostFrames = 100000;

// For a reader, which takes the source that it reads.
class BorrowedSource : public FrameSource {
  public:
    explicit BorrowedSource(FrameSource& source) : source_(source) {}

    const SourceInfo& info() const override { return source_.info(); }
    ReadResult Read(Frame& frame) override { return source_.Read(frame); }
    bool Seek(std::int64_t index) override { return source_.Seek(index); }

  private:
    FrameSource& source_;
};

// Number of source frames in a tenth of a second, from the stamps of its first frames.
std::int64_t StrideOf(FrameSource& source, std::int64_t start) {
    constexpr int kProbes = 3;
    constexpr double kMost = 10;
    if (start > 0 && !source.Seek(start)) return 1;
    double shortest_s = kEvery_s;
    std::optional<double> last_s;
    Frame frame;
    for (int i = 0; i < kProbes; ++i) {
        if (source.Read(frame).status != ReadStatus::kOk) continue;
        if (last_s && frame.stamp_s > *last_s)
            shortest_s = std::min(shortest_s, frame.stamp_s - *last_s);
        last_s = frame.stamp_s;
    }
    return source.Seek(start) ? static_cast<std::int64_t>(
                                    std::clamp(std::round(kEvery_s / shortest_s), 1.0, kMost))
                              : 1;
}

// The part of the selection to look at, in frames of the source. Nothing if it is too short.
std::optional<FrameSelection> PartToSee(FrameSource& source, const FrameSelection& selection) {
    const std::int64_t all = source.info().frame_count;
    if (selection.start < 0 || selection.stride < 1 || (all >= 0 && selection.start >= all))
        return std::nullopt;
    std::int64_t frames = all < 0 ? -1 : all - selection.start;
    if (selection.count >= 0) {
        const std::int64_t asked = selection.count > kMostFrames
                                       ? kMostFrames
                                       : selection.count * std::min(selection.stride, kMostFrames);
        frames = frames < 0 ? asked : std::min(frames, asked);
    }
    if (frames >= 0 && frames < kLeastViews) return std::nullopt;
    const std::int64_t stride = StrideOf(source, selection.start);
    return FrameSelection{selection.start, frames < 0 ? -1 : (frames + stride - 1) / stride,
                          stride};
}

}  // namespace

FirstSeconds LookAtFirstSeconds(FrameSource& source, const FrameSelection& selection,
                                bool one_camera, double colour_readout_s, double vignetting) {
    const std::optional<FrameSelection> part = PartToSee(source, selection);
    if (!part) return {};
    const SourceInfo info = source.info();
    const Brightening brightening(info.camera.width, info.camera.height, vignetting);
    CameraEstimator estimator(info.camera);
    ColourShiftEstimator registration;
    ColourDelayEstimator delay(info.camera);
    int views = 0;
    FrameReader reader(std::make_unique<BorrowedSource>(source), *part);
    Frame frame;
    std::optional<double> first_s, last_s;
    while (true) {
        const ReadResult read = reader.Next(frame);
        if (read.status == ReadStatus::kEnd || read.status == ReadStatus::kError) break;
        if (read.status != ReadStatus::kOk) continue;
        if (!first_s) first_s = frame.stamp_s;
        if (frame.stamp_s > *first_s + kWindow_s) break;
        if (last_s && frame.stamp_s < *last_s + kShortest_s) continue;
        last_s = frame.stamp_s;
        brightening.Apply(frame.colour);
        const EdgeView edges = MakeEdgeView(frame);
        if (views++ % 2 == 0) registration.Add(edges);
        delay.Add(frame, edges);
        if (one_camera) estimator.Add(frame);
    }
    FirstSeconds seen;
    seen.colour = registration.Estimate();
    if (estimator.frames() >= kLeastViews) seen.camera = estimator.Estimate();
    // A fit that went astray has a wrong read-out time, too.
    const bool believed = seen.camera && seen.camera->believed(info.camera_known);
    std::optional<double> readout_s;
    if (believed)
        readout_s = seen.camera->certain_readout_s(colour_readout_s);
    else if (colour_readout_s != 0)
        readout_s = colour_readout_s;
    seen.delay = delay.Estimate(readout_s);
    if (seen.colour) seen.colour->known = info.registration_known;
    return seen;
}

void LookWithoutVignetting(FrameSource& source, const FrameSelection& selection, double share,
                           double colour_readout_s, FirstSeconds& seen) {
    constexpr int kMostLooks = 3;
    constexpr double kStrong = 0.25;     // as of a wide lens
    constexpr double kLeastStep = 0.03;  // to be worth another look
    const auto known = [&](const CameraEstimate& estimate) {
        return estimate.believed(source.info().camera_known) && estimate.vignetting_known(share);
    };
    if (!seen.camera || known(*seen.camera)) return;
    double removed = kStrong;
    for (int look = 0; look < kMostLooks && source.Seek(0); ++look) {
        FirstSeconds found = LookAtFirstSeconds(source, selection, true, colour_readout_s, removed);
        if (!found.camera) return;
        const double rest = found.camera->vignetting;
        removed += rest;
        found.camera->vignetting = removed;
        if (!found.camera->vignetting_shown()) return;
        if (std::abs(rest) >= kLeastStep) continue;
        if (!known(*found.camera) || !source.Seek(0)) return;
        // What hides itself would show the same whatever is taken off.
        const FirstSeconds other =
            LookAtFirstSeconds(source, selection, true, colour_readout_s, removed + share);
        const double brighter = share / (1 - removed - share);  // in the corners
        if (other.camera && std::abs(other.camera->vignetting + brighter) < brighter / 2)
            seen = std::move(found);
        return;
    }
}

std::optional<DepthDistortionEstimate> LookAtDepth(FrameSource& source,
                                                   const FrameSelection& selection) {
    constexpr std::int64_t kMostParts = 5, kViewsOfPart = 40;
    const std::optional<FrameSelection> all = PartToSee(source, selection);
    if (!all) return std::nullopt;
    // A source whose length is not known shows its beginning only.
    const std::int64_t views = all->count < 0 ? kViewsOfPart * 2 : all->count;
    const std::int64_t parts = std::clamp<std::int64_t>(views / kViewsOfPart, 1, kMostParts);
    const std::int64_t of_part =
        parts < kMostParts ? views / parts : std::min(views / parts, kViewsOfPart);
    DepthDistortionEstimator estimator(source.info().camera);
    Frame frame;
    for (std::int64_t part = 0; part < parts; ++part) {
        const std::int64_t first = parts > 1 ? part * (views - of_part) / (parts - 1) : 0;
        estimator.StartPart();
        for (std::int64_t view = first; view < first + of_part; ++view) {
            if (!source.Seek(all->start + view * all->stride)) break;
            if (source.Read(frame).status == ReadStatus::kOk) estimator.Add(frame);
        }
    }
    return estimator.Estimate();
}

}  // namespace tessera
