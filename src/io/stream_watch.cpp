#include "io/stream_watch.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera {

double StreamWatch::Silence_s(double now_s) const { return now_s - std::min(depth_s_, colour_s_); }

std::string StreamWatch::NewSilence(double now_s) {
    constexpr double kSilence_s = 1.0;
    const bool silent = Silence_s(now_s) >= kSilence_s;
    if (!silent) told_ = false;
    if (!silent || told_) return {};
    told_ = true;
    const bool depth = now_s - depth_s_ >= kSilence_s, colour = now_s - colour_s_ >= kSilence_s;
    return fmt::format("no {} for {:.1f} s",
                       depth && colour ? "images"
                       : depth         ? "depth images"
                                       : "colour images",
                       Silence_s(now_s));
}

}  // namespace tessera
