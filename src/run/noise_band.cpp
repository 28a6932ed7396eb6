#include "run/noise_band.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "run/depth_scatter.h"

namespace tessera {
namespace {

constexpr int kViews = 8, kTries = 20;
constexpr int kWaits = 4;  // half a second each
constexpr std::int64_t kLeastSamples = 1000;
// A band that is wider by less changes nothing that could be measured.
constexpr double kClearly = 1.25;

// A source of which some results were read before the run: delivers them first.
class ReplayedSource : public FrameSource {
  public:
    struct Past {
        ReadResult result;
        Frame frame;
    };
    ReplayedSource(std::unique_ptr<FrameSource> source, std::deque<Past> past)
        : source_(std::move(source)), past_(std::move(past)) {}

    const SourceInfo& info() const override { return source_->info(); }
    ReadResult Read(Frame& frame) override {
        if (past_.empty()) return source_->Read(frame);
        Past first = std::move(past_.front());
        past_.pop_front();
        if (first.result.status == ReadStatus::kOk) std::swap(frame, first.frame);
        return first.result;
    }
    bool Seek(std::int64_t index) override {
        past_.clear();
        return source_->Seek(index);
    }
    Status RecordTo(const std::string& path, bool lossless_colour) override {
        return source_->RecordTo(path, lossless_colour);
    }

  private:
    std::unique_ptr<FrameSource> source_;
    std::deque<Past> past_;
};

// Reads on to the next frame. Returns false if there is none, or none in time.
bool NextFrame(FrameSource& source, const std::atomic<bool>& stop,
               std::deque<ReplayedSource::Past>& past) {
    for (int i = 0, waits = 0; i < kTries && waits < kWaits && !stop.load(); ++i) {
        ReplayedSource::Past next;
        next.result = source.Read(next.frame);
        const ReadStatus status = next.result.status;
        past.push_back(std::move(next));
        if (status == ReadStatus::kOk) return true;
        waits += status == ReadStatus::kWait;
        if (status == ReadStatus::kEnd || status == ReadStatus::kError) return false;
    }
    return false;
}

DepthScatter Typical(std::vector<DepthScatter> views) {
    if (views.empty()) return {};
    const auto middle = views.begin() + static_cast<std::ptrdiff_t>(views.size() / 2);
    std::ranges::nth_element(views, middle, {}, &DepthScatter::sigma_per_m);
    return *middle;
}

DepthScatter LookAt(const FrameSelection& selection, double max_depth_m,
                    const std::atomic<bool>& stop, std::unique_ptr<FrameSource>& source) {
    const SourceInfo info = source->info();
    std::vector<DepthScatter> views;
    std::deque<ReplayedSource::Past> past;
    const auto look = [&] {
        if (!NextFrame(*source, stop, past)) return false;
        const DepthScatter seen = MeasureDepthScatter(past.back().frame.depth_m, max_depth_m);
        if (seen.samples >= kLeastSamples) views.push_back(seen);
        return true;
    };
    const auto step = static_cast<std::int64_t>(std::clamp(std::round(info.fps), 1.0, 100.0));
    if (info.live || !source->Seek(selection.start)) {
        look();
        source = std::make_unique<ReplayedSource>(std::move(source), std::move(past));
        return Typical(std::move(views));
    }
    for (int i = 0; i < kViews && source->Seek(selection.start + i * step) && look(); ++i)
        past.clear();
    source->Seek(0);
    return Typical(std::move(views));
}

}  // namespace

std::string FitBandToNoise(const FrameSelection& selection, PipelineConfig& config,
                           std::unique_ptr<FrameSource>& source, const std::atomic<bool>& stop) {
    if (config.band_sigmas <= 0 || config.map.band_per_m > 0) return {};
    const DepthScatter seen = LookAt(selection, config.frame.max_depth_m, stop, source);
    BlockMap::Config& map = config.map;
    map.band_per_m = config.band_sigmas * seen.sigma_per_m;
    const auto band_mm = [&](double depth_m) {
        return 1000 * map.band().At(static_cast<float>(depth_m));
    };
    const double clearly_mm = kClearly * 1000 * map.truncation_m;
    if (band_mm(config.frame.max_depth_m) < clearly_mm) map.band_per_m = 0;
    if (band_mm(seen.depth_m) < clearly_mm) return {};
    return fmt::format(
        "this camera's depth scatters by {:.0f} mm at {:.1f} m: the map's band is {:.0f} mm there "
        "instead of {:.0f}",
        1000 * seen.sigma_per_m * seen.depth_m * seen.depth_m, seen.depth_m, band_mm(seen.depth_m),
        1000 * map.truncation_m);
}

}  // namespace tessera
