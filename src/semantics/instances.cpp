#include "semantics/instances.h"

#include <algorithm>
#include <limits>
#include <set>

namespace tessera {
namespace {

constexpr int kLeastVisible = 20;       // sampled pixels; smaller views say nothing
constexpr double kSameClassOverlap = 0.25, kOtherClassOverlap = 0.4;  // intersection over union, in the image
constexpr double kContained = 0.5, kContainedShare = 0.2;
constexpr double kSameBox = 0.3;        // intersection over union of 3D boxes
constexpr double kFree = 0.5;           // more of a region held by others is busy
constexpr double kCovers = 0.6;         // of both, for one detection to say that two are one
constexpr int kTogether = 8;            // times said, and twice as often as the contrary
constexpr int kTrialFrames = 12;        // in view, before one that is not confirmed may be dropped
constexpr double kHeldShare = 0.3;     // of a detection's pixels shown by the map
constexpr double kStandingShare = 0.5;  // of the rate asked for
constexpr double kClassShare = 0.5;     // of the votes, to be confirmed

double BoxOverlap(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
    const Eigen::AlignedBox3d both = a.intersection(b);
    if (a.isEmpty() || b.isEmpty() || both.isEmpty()) return 0;
    const double common = both.volume(), all = a.volume() + b.volume() - common;
    return all > 0 ? common / all : 0;
}

int At(const std::map<InstanceId, int>& counts, InstanceId id) {
    const auto found = counts.find(id);
    return found == counts.end() ? 0 : found->second;
}

// How well a detection fits a known object; 0: not at all.
double Fit(const ObservedObject& o, const InstanceRecord& record, int common, int visible, bool same_class) {
    const double all = o.pixels + visible - common, overlap = all > 0 ? common / all : 0;
    const double contained = static_cast<double>(common) / std::max(1, std::min(o.pixels, visible));
    const double box = BoxOverlap(o.box, record.box);
    if (!same_class) return overlap >= kOtherClassOverlap ? overlap : 0;
    const bool part = contained >= kContained && (common >= kContainedShare * o.pixels || box >= kSameBox);
    return overlap >= kSameClassOverlap || part ? 0.2 + overlap + 0.2 * box : 0;
}

}  // namespace

InstanceId Instances::Resolve(InstanceId id) const {
    while (records_[id].merged_into != 0) id = records_[id].merged_into;
    return records_[id].dropped ? InstanceId{0} : id;
}

int Instances::ClassOf(InstanceId id) const {
    const auto& votes = records_[id].class_votes;
    const auto best = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
    return best == votes.end() ? 0 : best->first;
}

double Instances::Probability(InstanceId id) const {
    const InstanceRecord& r = records_[id];
    const auto votes = r.class_votes.find(ClassOf(id));
    return votes == r.class_votes.end() ? 0 : votes->second / std::max(1, r.observations);
}

bool Instances::stands(InstanceId id) const {
    if (!confirmed(id)) return false;
    return records_[id].observations >= kStandingShare * config_.min_rate * records_[id].visible_frames;
}

std::vector<InstanceId> Instances::Match(const std::vector<ObservedObject>& observed, const std::map<InstanceId, int>& visible) {
    std::vector<InstanceId> match(observed.size(), 0);
    Assign(observed, visible, match);
    const std::set<InstanceId> claimed(match.begin(), match.end());
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (match[i] != 0 || observed[i].pixels == 0) continue;
        int busy = 0;  // held by what no other detection of this frame explains
        for (const auto& [id, pixels] : observed[i].overlaps)
            if (!claimed.contains(id) && ClassOf(id) == observed[i].class_id) busy += pixels;
        if (busy < kFree * observed[i].pixels) match[i] = Add();
    }
    for (const auto& [id, pixels] : visible)
        if (pixels >= kLeastVisible || std::ranges::find(match, id) != match.end()) ++records_[id].visible_frames;
    for (std::size_t i = 0; i < observed.size(); ++i)
        if (match[i] != 0) Update(match[i], observed[i], At(visible, match[i]));
    GatherEvidence(observed, visible, match);
    for (InstanceId id = 1; id <= last(); ++id) Judge(id);
    for (InstanceId& id : match) id = Resolve(id);
    return match;
}

// Best fits first, one to one.
void Instances::Assign(const std::vector<ObservedObject>& observed, const std::map<InstanceId, int>& visible,
                       std::vector<InstanceId>& match) const {
    struct Candidate {
        double fit;
        std::size_t detection;
        InstanceId id;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < observed.size(); ++i)
        for (const auto& [id, common] : observed[i].overlaps) {
            const double fit = Fit(observed[i], records_[id], common, At(visible, id), ClassOf(id) == observed[i].class_id);
            if (fit > 0) candidates.push_back({fit, i, id});
        }
    std::ranges::stable_sort(candidates, std::greater{}, &Candidate::fit);
    std::set<InstanceId> taken;
    for (const Candidate& c : candidates) {
        if (match[c.detection] != 0 || taken.contains(c.id)) continue;
        match[c.detection] = c.id;
        taken.insert(c.id);
    }
}

InstanceId Instances::Add() {
    if (records_.size() > std::numeric_limits<InstanceId>::max()) return 0;
    records_.emplace_back();
    records_.back().visible_frames = 1;
    return last();
}

void Instances::Update(InstanceId id, const ObservedObject& observed, int visible) {
    InstanceRecord& r = records_[id];
    r.class_votes[observed.class_id] += observed.probability;
    ++r.class_counts[observed.class_id];
    ++r.observations;
    r.held += visible >= kHeldShare * observed.pixels;
    r.box.extend(observed.box);
}

// Confirmed once seen often enough; dropped if that does not happen while it is in view.
void Instances::Judge(InstanceId id) {
    InstanceRecord& r = records_[id];
    if (r.public_id > 0 || r.dropped || r.merged_into != 0) return;
    const double rate = static_cast<double>(r.observations) / std::max(1, r.visible_frames);
    const auto count = r.class_counts.find(ClassOf(id));
    const double share = count == r.class_counts.end() ? 0 : static_cast<double>(count->second) / r.observations;
    if (r.observations >= config_.min_observations && rate >= config_.min_rate && share >= kClassShare && 2 * r.held >= r.observations)
        r.public_id = ++last_public_;
    else if (r.visible_frames >= kTrialFrames && rate < config_.min_rate)
        r.dropped = true;
}

void Instances::GatherEvidence(const std::vector<ObservedObject>& observed, const std::map<InstanceId, int>& visible,
                               const std::vector<InstanceId>& match) {
    const auto key = [](InstanceId a, InstanceId b) { return std::pair(std::min(a, b), std::max(a, b)); };
    std::set<std::pair<InstanceId, InstanceId>> together;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        for (const auto& [id, common] : observed[i].overlaps) {
            if (match[i] == 0 || id == match[i] || ClassOf(id) != ClassOf(match[i])) continue;
            const auto covers = [&](InstanceId which) {
                const int pixels = At(visible, which);
                return pixels >= kLeastVisible && At(observed[i].overlaps, which) >= kCovers * pixels;
            };
            if (std::ranges::find(match, id) != match.end())
                ++evidence_[key(id, match[i])].apart;
            else if (covers(id) && covers(match[i]))
                together.insert(key(id, match[i]));
        }
    }
    for (const auto& pair : together) {
        PairEvidence& e = evidence_[pair];
        if (++e.together >= kTogether && e.together > 2 * e.apart) Join(pair.first, pair.second);
    }
}

// The one with the smaller public number stays; else the older one.
void Instances::Join(InstanceId a, InstanceId b) {
    a = Resolve(a), b = Resolve(b);
    if (a == b || a == 0 || b == 0) return;
    const auto rank = [&](InstanceId id) {
        return std::pair(records_[id].public_id > 0 ? records_[id].public_id : std::numeric_limits<int>::max(), id);
    };
    if (rank(b) < rank(a)) std::swap(a, b);
    InstanceRecord &kept = records_[a], &gone = records_[b];
    for (const auto& [class_id, votes] : gone.class_votes) kept.class_votes[class_id] += votes;
    for (const auto& [class_id, count] : gone.class_counts) kept.class_counts[class_id] += count;
    kept.observations += gone.observations;
    kept.visible_frames = std::max(kept.visible_frames, gone.visible_frames);
    kept.box.extend(gone.box);
    gone.merged_into = a;
}

void Instances::SaveState(StateWriter& state) const {
    state.Put(static_cast<std::uint64_t>(records_.size()));
    for (const InstanceRecord& r : records_) {
        state.Put(static_cast<std::uint64_t>(r.class_votes.size()));
        for (const auto& [id, sum] : r.class_votes) {
            state.Put(id);
            state.Put(sum);
            state.Put(r.class_counts.contains(id) ? r.class_counts.at(id) : 0);
        }
        for (const int value : {r.observations, r.visible_frames, r.held, r.public_id}) state.Put(value);
        state.Put(r.merged_into);
        state.Put(r.dropped);
        state.Put(r.box.isEmpty());
        if (r.box.isEmpty()) continue;
        state.Put(r.box.min());
        state.Put(r.box.max());
    }
    state.Put(static_cast<std::uint64_t>(evidence_.size()));
    for (const auto& [pair, evidence] : evidence_) {
        state.Put(pair.first);
        state.Put(pair.second);
        state.Put(evidence.together);
        state.Put(evidence.apart);
    }
    state.Put(last_public_);
}

bool Instances::LoadState(StateReader& state) {
    std::uint64_t count = 0, votes = 0;
    if (!state.Get(count) || count < 1 || count > 65536) return false;
    std::vector<InstanceRecord> records;
    for (std::uint64_t i = 0; i < count; ++i) {
        InstanceRecord& r = records.emplace_back();
        state.Get(votes);
        for (; state.ok() && votes > 0; --votes) {
            int id = 0, seen = 0;
            double sum = 0;
            if (!state.Get(id) || !state.Get(sum) || !state.Get(seen)) return false;
            r.class_votes[id] = sum;
            r.class_counts[id] = seen;
        }
        for (int* value : {&r.observations, &r.visible_frames, &r.held, &r.public_id}) state.Get(*value);
        state.Get(r.merged_into);
        state.Get(r.dropped);
        bool empty = true;
        state.Get(empty);
        if (!empty && (!state.Get(r.box.min()) || !state.Get(r.box.max()))) return false;
        // Merges go to older instances, so that following them ends.
        if (!state.ok() || r.merged_into >= std::max<std::uint64_t>(i, 1)) return false;
    }
    std::map<std::pair<InstanceId, InstanceId>, PairEvidence> evidence;
    state.Get(count);
    for (; state.ok() && count > 0; --count) {
        std::pair<InstanceId, InstanceId> pair;
        PairEvidence found;
        if (!state.Get(pair.first) || !state.Get(pair.second) || !state.Get(found.together) || !state.Get(found.apart)) return false;
        if (pair.first >= records.size() || pair.second >= records.size()) return false;
        evidence[pair] = found;
    }
    if (!state.Get(last_public_) || !state.at_end()) return false;
    records_ = std::move(records);
    evidence_ = std::move(evidence);
    return true;
}

}  // namespace tessera
