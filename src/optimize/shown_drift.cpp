#include "optimize/shown_drift.h"

#include <algorithm>

#include "optimize/overlaps.h"

namespace tessera {

ShownDrift FindShownDrift(const Keyframes& keyframes, double aligned_factor, double least_m,
                          double max_drift) {
    // Two alignments with older keyframes must say so: one may be wrong, and neighbours in time
    // show no drift.
    constexpr int kRecent = 3, kWitnesses = 2;
    // Of a scan with n times as many keyframes, every (n + 1)-th is worth a solution.
    constexpr int kKeyframes = 50;
    ShownDrift shown;
    int witnesses = 0;
    double earlier_m = 0;
    const int last = keyframes.last().id;
    for (int id = last; id > 0; --id) {
        if (id == last - kRecent && witnesses < kWitnesses) return {};
        for (const Overlap& overlap : keyframes[id].overlaps) {
            if (!IsOlder(overlap, id) || !Contradicts(overlap, aligned_factor)) continue;
            const Keyframe& old = keyframes[overlap.with];
            const Drift implied =
                DriftOf(old, keyframes[id], overlap.T_with_this_aligned, max_drift);
            if (!implied.conceivable || implied.off_m < least_m) continue;
            if (id <= last - kRecent) {
                earlier_m = std::max(earlier_m, implied.off_m);
                continue;
            }
            ++witnesses;
            if (implied.off_m <= shown.drift.off_m) continue;
            shown.old = &old;
            shown.drift = implied;
        }
    }
    if (witnesses < kWitnesses) return {};
    shown.worth_a_solution =
        shown.drift.off_m > earlier_m || last % (1 + keyframes.size() / kKeyframes) == 0;
    return shown;
}

}  // namespace tessera
