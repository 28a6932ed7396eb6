// A user of a live run who acts at random, together with the window, and who measures the memory
// and how long frames waited for their pose.
#pragma once

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "../apps/config_options.h"
#include "core/stopwatch.h"
#include "run/run.h"
#include "run/timings.h"

namespace tessera::soak {

inline constexpr int kParts = 6;
inline constexpr double kMostWait_ms = 250, kMostGrowth = 0.02;

struct Options {
    std::string source = "openni2:", labels, out = "build/soak";
    double minutes = 30, reset_s = 60;
    unsigned seed = 1;
    ConfigOptions config;
};

inline double RssMb() {
    long pages = 0, resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
        std::fclose(file);
    }
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

inline double HeapMb() {
    const struct mallinfo2 heap = mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd) / (1 << 20);
}

// One part of the run.
struct Part {
    std::vector<double> rss_mb, heap_mb, wait_ms;  // heap: in use, without the maps' voxels
    int lost = 0;
};

// Mean and its standard error.
inline std::string MeanOf(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double mean = 0, square = 0;
    for (const double v : values) mean += v / n;
    for (const double v : values) square += (v - mean) * (v - mean);
    return n < 2 ? "?" : fmt::format("{:.0f} +- {:.0f}", mean, std::sqrt(square / (n * (n - 1))));
}

// After a reset, when what is left is not the map's.
inline double LeastMb(const Part& part) {
    return part.rss_mb.empty() ? 0 : std::ranges::min(part.rss_mb);
}

// The user and the window in one. Owns its thread's data; the run sees only the link.
class RestlessUser {
  public:
    RestlessUser(const Options& options, const RunConfig& config, ViewerLink& link)
        : options_(options), link_(link), random_(options.seed) {
        settings_.labels.prediction = config.labels.prediction;
        settings_.loops = config.loops.enabled;
    }

    // Until the time is over, then asks the run to end.
    void Use() {
        const Stopwatch watch;
        const double whole_s = 60 * options_.minutes;
        double next_sample_s = 0;
        while (watch.ElapsedMs() < 1000 * whole_s && !link_.ended.load()) {
            const double now_s = watch.ElapsedMs() / 1000;
            Part& part = parts_[static_cast<std::size_t>(
                std::min(kParts - 1, static_cast<int>(kParts * now_s / whole_s)))];
            TakeWhatIsShown(part);
            if (now_s >= next_sample_s) {
                part.rss_mb.push_back(RssMb());
                part.heap_mb.push_back(HeapMb());
                next_sample_s = now_s + 1;
            }
            Act(now_s);
            std::this_thread::sleep_for(std::chrono::milliseconds(kStep_ms));
        }
        Send(ViewerCommand::Kind::kResume, "");
        Send(ViewerCommand::Kind::kStop, "");
    }

    // Returns whether the run kept its promises.
    bool Report() const {
        fmt::print("{:>4} {:>8} {:>8} {:>8} {:>8} {:>6} {:>8} {:>8} {:>8}\n", "part", "RSS MB",
                   "least MB", "max MB", "heap MB", "frames", "wait ms", "95 % ms", "max ms");
        double longest_ms = 0;
        for (int i = 0; i < kParts; ++i) {
            const Part& part = parts_[static_cast<std::size_t>(i)];
            const StageStatistics rss = SummariseDurations(part.rss_mb);
            const StageStatistics wait = SummariseDurations(part.wait_ms);
            longest_ms = std::max(longest_ms, wait.max_ms);
            fmt::print(
                "{:>4} {:>8.0f} {:>8.0f} {:>8.0f} {:>8.0f} {:>6} {:>8.1f} {:>8.1f} {:>8.1f}\n",
                i + 1, rss.median_ms, LeastMb(part), rss.max_ms,
                SummariseDurations(part.heap_mb).median_ms, part.wait_ms.size(), wait.median_ms,
                wait.p95_ms, wait.max_ms);
        }
        for (const auto& [name, count] : acts_) fmt::print("{} {}, ", count, name);
        const double first = LeastMb(parts_[1]), last = LeastMb(parts_[kParts - 1]);
        const auto half =
            after_reset_mb_.begin() + static_cast<std::ptrdiff_t>(after_reset_mb_.size() / 2);
        fmt::print("\nin use {} s after a reset: {} MB in the first half, {} MB in the second\n",
                   kSettled_s, MeanOf({after_reset_mb_.begin(), half}),
                   MeanOf({half, after_reset_mb_.end()}));
        fmt::print("memory {:+.1f} % from part 2 to {}, longest wait {:.0f} ms\n",
                   100 * (last / first - 1), kParts, longest_ms);
        return last / first - 1 <= kMostGrowth && longest_ms <= kMostWait_ms;
    }

  private:
    static constexpr int kStep_ms = 20;
    static constexpr double kSettled_s = 2;

    void TakeWhatIsShown(Part& part) {
        FrameUpdate frame;
        while (link_.frames.TryPop(frame)) {
            part.wait_ms.push_back(frame.latency_ms);
            if (frame.latency_ms > kMostWait_ms) TellLong(frame);
            part.lost += !frame.report.tracked();
        }
        ImageUpdate image;
        MeshUpdate mesh;
        std::vector<MapObject> objects;
        LabelUpdate labels;
        std::string message;
        while (link_.images.TryPop(image)) {
        }
        while (link_.meshes.TryPop(mesh)) {
        }
        while (link_.objects.TryPop(objects)) {
        }
        while (link_.labels.TryPop(labels)) {
        }
        while (link_.messages.TryPop(message)) {
        }
    }

    static void TellLong(const FrameUpdate& frame) {
        const FrameReport& r = frame.report;
        fmt::print(stderr,
                   "frame {} waited {:.0f} ms: prepare {:.0f}, track {:.0f} ({}), allocate {:.0f}, "
                   "fuse {:.0f}\n",
                   r.index, frame.latency_ms, r.prepare_ms, r.track_ms, ToString(r.method),
                   r.fusion.allocate_ms, r.fusion.fuse_ms);
    }

    void Send(ViewerCommand::Kind kind, const std::string& path) {
        link_.commands.Push({kind, path});
    }

    // True once in `every_s` on average.
    bool Sometimes(double every_s, const char* name) {
        if (std::uniform_real_distribution<>(0, 1)(random_) >= 0.001 * kStep_ms / every_s)
            return false;
        ++acts_[name];
        return true;
    }

    void Act(double now_s) {
        using Kind = ViewerCommand::Kind;
        if (now_s < resume_s_) return;
        if (resume_s_ > 0) Send(Kind::kResume, ""), resume_s_ = 0;
        if (now_s >= reset_s_ + kSettled_s) {
            after_reset_mb_.push_back(HeapMb());
            reset_s_ = std::numeric_limits<double>::infinity();
        }
        // At fixed times, so that the parts can be compared.
        if (now_s >= next_reset_s_) {
            ++acts_["resets"];
            fmt::print(stderr, "before reset {}: RSS {:.0f}, heap {:.0f} MB\n", acts_["resets"],
                       RssMb(), HeapMb());
            next_reset_s_ += options_.reset_s;
            Send(Kind::kReset, "");
            reset_s_ = now_s;
        }
        if (Sometimes(20, "meshes saved")) Send(Kind::kSaveMesh, options_.out + "/saved.ply");
        if (Sometimes(40, "recordings begun or ended")) {
            const std::string path = fmt::format("{}/recorded{}", options_.out, recordings_ % 2);
            if (!recording_) std::filesystem::remove_all(path);
            Send(recording_ ? Kind::kStopRecording : Kind::kRecord, path);
            recordings_ += recording_;
            recording_ = !recording_;
        }
        if (Sometimes(30, "pauses")) Send(Kind::kPause, ""), resume_s_ = now_s + 1;
        bool changed = false;
        if (Sometimes(5, "switches of the tracker")) {
            settings_.method = kTrackingMethods[random_() % kTrackingMethods.size()].method;
            ++settings_.method_choices;
            changed = true;
        }
        if (settings_.fusing ? Sometimes(30, "times without fusion")
                             : Sometimes(3, "times with it"))
            settings_.fusing ^= true, changed = true;
        if (Sometimes(30, "switches of loops") && settings_.loops)
            settings_.loops = !*settings_.loops, changed = true;
        if (Sometimes(30, "switches of the prealignment"))
            settings_.prealign ^= true, changed = true;
        if (changed) link_.settings.Push(ViewerSettings(settings_));
    }

    const Options& options_;
    ViewerLink& link_;
    std::mt19937 random_;
    ViewerSettings settings_;
    std::array<Part, kParts> parts_;
    std::map<std::string, int> acts_;
    std::vector<double> after_reset_mb_;  // heap; what stays when nothing is scanned
    double resume_s_ = 0, next_reset_s_ = options_.reset_s;
    double reset_s_ = std::numeric_limits<double>::infinity();  // the latest, if not looked at yet
    int recordings_ = 0;
    bool recording_ = false;
};

}  // namespace tessera::soak
