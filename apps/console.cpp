#include "console.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/printable.h"

namespace tessera {

Console::Console() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void Console::Info(const std::string& text) {
    ClearBar();
    spdlog::info("{}", Printable(text));
}

void Console::Warning(const std::string& text) {
    ClearBar();
    spdlog::warn("{}", Printable(text));
}

void Console::ClearBar() {
    if (bar_shown_) std::fputs("\r\033[K", stderr);
    bar_shown_ = false;
}

void Console::ShowProgress(const RunCounts& counts, std::int64_t total) {
    if (!is_terminal_) return;
    const double lap_ms = watch_.LapMs();
    elapsed_ms_ += lap_ms;
    since_bar_ms_ += lap_ms;
    if (since_bar_ms_ < 100) return;
    since_bar_ms_ = 0;
    const double fps = 1000.0 * static_cast<double>(counts.frames) / elapsed_ms_;
    std::string line = fmt::format("{} frames", counts.frames);
    if (total > 0) {
        constexpr int kWidth = 30;
        const auto filled = static_cast<std::size_t>(
            std::min<std::int64_t>(kWidth, kWidth * counts.frames / total));
        const double left_s = static_cast<double>(total - counts.frames) / fps;
        line = fmt::format("[{}{}] {}/{}  {:.0f} s left", std::string(filled, '#'),
                           std::string(kWidth - filled, '.'), counts.frames, total,
                           std::max(0.0, left_s));
    }
    fmt::print(stderr, "\r\033[K{}  {:.1f} frames/s  lost {}", line, fps, counts.lost);
    std::fflush(stderr);
    bar_shown_ = true;
}

RunObserver Console::Observer() {
    RunObserver observer;
    observer.on_open = [this](const SourceInfo& source) {
        for (const std::string& note : source.notes) Info(note);
        for (const std::string& warning : source.warnings) Warning(warning);
    };
    observer.on_warning = [this](const std::string& text) { Warning(text); };
    observer.on_frame = [this](const RunCounts& counts, std::int64_t total) {
        ShowProgress(counts, total);
    };
    return observer;
}

}  // namespace tessera
