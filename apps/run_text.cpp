#include "run_text.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>

namespace tessera {

std::string AteText(const AteResult& ate) {
    const ErrorStatistics& e = ate.error_m;
    std::string text = fmt::format(
        "ATE RMSE {:.4f} m (mean {:.4f}, median {:.4f}, max {:.4f}), {} pairs, SE(3) alignment "
        "without scale over all "
        "frames, {:.1f} % {}\n",
        e.rmse, e.mean, e.median, e.max, ate.pairs.size(), 100 * ate.tracked_fraction,
        ate.of_frames ? "of the frames tracked" : "of the poses have a reference");
    if (!ate.warning.empty()) text += "note: " + ate.warning + "\n";
    return text;
}

std::string DriftText(const DriftResult& drift) {
    const double degrees = 180 / std::numbers::pi;
    std::string text = fmt::format("path {:.2f} m; relative error (RMSE) over\n", drift.path_m);
    for (const DriftResult::OverDistance& d : drift.over_distance)
        text += fmt::format("{:8.0f} m  {:7.3f} %  {:7.4f} deg/m  {} pairs\n", d.distance_m,
                            100 * d.trans_fraction, degrees * d.rot_rad_per_m, d.pairs);
    if (drift.revisits.empty()) return text + "no place was visited twice\n";
    return text + fmt::format(
                      "revisits: {}, translation RMSE {:.4f} m (max {:.4f}), rotation RMSE "
                      "{:.3f} deg\n",
                      drift.revisits.size(), drift.revisit_m.rmse, drift.revisit_m.max,
                      degrees * drift.revisit_rad.rmse);
}

std::string LabelsText(const LabelSummary& labels, double wall_s) {
    std::map<std::string, int> counts;
    for (const MapObject& object : labels.objects) ++counts[object.class_name];
    std::string text =
        fmt::format("labels: {} frames processed ({:.1f} per second), {} detections, {} objects",
                    labels.frames, static_cast<double>(labels.frames) / std::max(wall_s, 1e-9),
                    labels.detections, labels.objects.size());
    const char* separator = ": ";
    for (const auto& [name, count] : counts)
        text += fmt::format("{}{} {}", std::exchange(separator, ", "), count, name);
    return text + "\n";
}

// What tracking and mapping take. Often the source is slower: a built-in scene is rendered while it
// is read.
std::string SpeedText(const RunSummary& s) {
    const auto median_ms = [&](std::initializer_list<const char*> stages) {
        double sum_ms = 0;
        for (const auto& [stage, statistics] : s.stages)
            if (std::ranges::find(stages, stage) != stages.end()) sum_ms += statistics.median_ms;
        return sum_ms;
    };
    std::string text = fmt::format(
        "median {:.1f} ms to track a frame and {:.1f} ms to fuse it; {:.1f} frames/s",
        median_ms({"prepare", "track"}), median_ms({"moving", "allocate", "fuse"}), s.fps);
    const double reading_ms = median_ms({"decode"});
    if (2 * reading_ms > median_ms({"frame"}))
        text += fmt::format(", because the source takes {:.1f} ms", reading_ms);
    return text + "\n";
}

std::string RunText(const RunRequest& request, const RunSummary& s) {
    const RunCounts& n = s.counts;
    std::string text =
        fmt::format("{}{}: {} frames, {} tracked, {} fused, {} lost, {} skipped\n", request.source,
                    s.stopped ? " (stopped)" : "", n.frames, n.tracked, n.fused, n.lost, n.skipped);
    if (n.frames == 0) return text;  // the files in the folder are not of this run
    if (10 * n.degenerate > n.tracked)
        text += fmt::format(
            "note: {} of the tracked frames are degenerate: the scene leaves a motion open, along "
            "which the path can be wrong\n",
            n.degenerate);
    if (request.live)
        text += fmt::format(
            "live: {} frame{} dropped for newer ones, {} tracked but not fused because mapping was "
            "busy\n",
            n.dropped, n.dropped == 1 ? "" : "s", n.unfused);
    if (request.live && 20 * (n.dropped + n.unfused) > n.frames)
        text += fmt::format(
            "note: frames came every {:.0f} ms, faster than this machine maps; larger voxels "
            "(mapping.voxel_size_m), --loop-closure off or fewer labels (labels.max_rate_hz) "
            "help\n",
            1000 / s.source.fps);
    if (s.ate) text += AteText(*s.ate);
    text += SpeedText(s);
    constexpr double kMegabyte = 1024.0 * 1024.0;
    text += fmt::format(
        "map {} blocks, {:.0f} MB ({:.1f} bytes per voxel); peak memory {:.0f} MB\n", s.map.blocks,
        static_cast<double>(s.map.bytes) / kMegabyte, s.map.bytes_per_voxel, s.peak_rss_mb);
    if (s.labels) text += LabelsText(*s.labels, s.wall_s);
    std::error_code ignored;  // an empty mesh has no picture
    for (const auto& [file, what] :
         {std::pair{"trajectory.txt", "camera path, TUM format"},
          {"mesh.ply", "coloured mesh"},
          {"preview.png", "picture of the mesh"},
          {s.labels ? "objects.json" : "", "labelled objects, with boxes"},
          {"detections.txt", "detections by frame"},
          {"timings.json", "time per stage"},
          {"run.json", "settings and statistics of this run"}})
        if (*file != '\0' && std::filesystem::exists(request.output_folder + "/" + file, ignored))
            text += fmt::format("  {}/{}  {}\n", request.output_folder, file, what);
    return text;
}

}  // namespace tessera
