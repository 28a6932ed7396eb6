#include "viz/quality.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera {
namespace {

using Level = QualityLevel;
constexpr double kSilence_s = 3;

bool IsMany(std::int64_t some, std::int64_t all) {
    return static_cast<double>(some) > kManyDropped * static_cast<double>(all);
}

std::string Percent(std::int64_t some, std::int64_t all) {
    return fmt::format("{:.0f} %", 100.0 * static_cast<double>(some) /
                                       static_cast<double>(std::max<std::int64_t>(all, 1)));
}

// A whole run in one sentence.
Quality AtTheEnd(const RunCounts& n) {
    const std::string all = fmt::format("{} of {} frames tracked", n.tracked, n.frames);
    if (IsMany(n.dropped, n.frames))
        return {Level::kWarning, "Finished",
                fmt::format("{}; {} dropped: this computer was too slow", all, n.dropped)};
    if (IsMany(n.lost, n.frames))
        return {Level::kWarning, "Finished", fmt::format("{}; lost in {}", all, n.lost)};
    return {Level::kIdle, "Finished", all};
}

// Of a frame that was tracked well.
Quality OfGoodFrame(const QualitySigns& s) {
    const FrameReport& report = s.frame->report;
    if (IsMany(s.recent.dropped, s.recent.frames))
        return {Level::kWarning, "Dropping frames",
                Percent(s.recent.dropped, s.recent.frames) +
                    " in the last 2 s: the computer is too slow, move slower"};
    if (report.track.degenerate)
        return {Level::kWarning, "Unsure",
                report.track.reason.empty() ? "the scene shows too little shape here"
                                            : report.track.reason};
    if (!s.fusing)
        return {Level::kWarning, "Tracking only",
                "nothing is added to the map: that is switched off"};
    if (IsMany(s.recent.unfused, s.recent.frames))
        return {Level::kWarning, "Map is behind",
                Percent(s.recent.unfused, s.recent.frames) +
                    " of the frames were not added to the map in the last 2 s"};
    if (s.detector_failed)
        return {Level::kWarning, "Labelling has failed", "the messages say why; the scan goes on"};
    if (report.begins_part)
        return {Level::kGood, "A new part",
                "of the scan begins; it is joined when a place of the rest is seen"};
    if (report.first) return {Level::kGood, "Started", "the map begins with this frame"};
    return {Level::kGood, "Good",
            report.fused ? "tracked and added to the map" : "tracked, not added to the map"};
}

}  // namespace

Quality QualityOf(const QualitySigns& s) {
    if (s.frame == nullptr)
        return s.ended ? Quality{Level::kIdle, "Ended", "no frame was received"}
                       : Quality{Level::kIdle, "Waiting", "for the first frame"};
    if (s.ended) return AtTheEnd(s.frame->counts);
    const TrackResult& track = s.frame->report.track;
    if (s.paused) return {Level::kIdle, "Paused", "nothing is tracked or added to the map"};
    if (s.silent_s > kSilence_s)
        return {Level::kIdle, "Waiting",
                fmt::format("no frame for {:.0f} s: the source has ended or delivers none",
                            s.silent_s)};
    if (track.status == TrackStatus::kLost) return {Level::kBad, "Lost", track.reason};
    if (track.status == TrackStatus::kPoor)
        return {Level::kWarning, "Poor, not added to the map", track.reason};
    return OfGoodFrame(s);
}

}  // namespace tessera
