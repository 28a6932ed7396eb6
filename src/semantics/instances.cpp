#include "semantics/instances.h"

#include <algorithm>
#include <limits>
#include <set>

namespace tessera {
namespace {

constexpr int kLeastVisible = 20;  // sampled pixels; smaller views carry no evidence
// Thresholds of intersection over union in the image.
constexpr double kSameClassOverlap = 0.25, kOtherClassOverlap = 0.4;
constexpr double kContained = 0.5, kContainedShare = 0.2;
constexpr double kSameSpace = 0.3;  // intersection over union of the 3D boxes
constexpr double kSameUnseen = 0.4;
constexpr double kFree = 0.5;  // a region is busy if other instances hold at least this share of it
// Share of both instances that one detection must cover to suggest they are one.
constexpr double kCovers = 0.6;
constexpr int kTogether = 12;  // join after this much evidence,
constexpr int kOftener = 4;    // and more than this many times the evidence against it
// An unconfirmed instance in view for this many frames may be dropped.
constexpr int kTrialFrames = 12;
constexpr double kHeldShare = 0.3;      // the map must show this share of the detection's pixels
constexpr double kStandingShare = 0.5;  // of the configured rate
constexpr double kClassShare = 0.5;     // share of the votes needed to be confirmed

template <typename Box>
double IntersectionOverUnion(const Box& a, const Box& b) {
    const Box both = a.intersection(b);
    if (a.isEmpty() || b.isEmpty() || both.isEmpty()) return 0;
    const double common = both.volume(), all = a.volume() + b.volume() - common;
    return all > 0 ? common / all : 0;
}

template <typename Value>
Value At(const std::map<InstanceId, Value>& values, InstanceId id) {
    const auto found = values.find(id);
    return found == values.end() ? Value{} : found->second;
}

// Score of a detection against a known object that the map shows; 0: no match. If two objects lie
// within the detection, the one whose outline in the image matches the detector's box scores
// higher, even if the segment includes parts of the other.
double Fit(const ObservedObject& o, const InstanceRecord& record, int common,
           const VisibleObject& visible, bool same_class) {
    const double all = o.pixels + visible.pixels - common, overlap = all > 0 ? common / all : 0;
    const double image = IntersectionOverUnion(o.image_box, visible.image_box),
                 space = IntersectionOverUnion(o.box, record.box);
    if (!same_class) return overlap >= kOtherClassOverlap ? overlap + image : 0;
    const double contained =
        static_cast<double>(common) / std::max(1, std::min(o.pixels, visible.pixels));
    const bool part =
        contained >= kContained && (common >= kContainedShare * o.pixels || space >= kSameSpace);
    return overlap >= kSameClassOverlap || part ? 0.2 + overlap + image + 0.2 * space : 0;
}

}  // namespace

InstanceId Instances::Resolve(InstanceId id) const {
    while (records_[id].merged_into != 0) id = records_[id].merged_into;
    return records_[id].dropped ? InstanceId{0} : id;
}

int Instances::ClassOf(InstanceId id) const {
    const auto& votes = records_[id].class_votes;
    const auto best =
        std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
    return best == votes.end() ? 0 : best->first;
}

double Instances::Probability(InstanceId id) const {
    const InstanceRecord& r = records_[id];
    const auto votes = r.class_votes.find(ClassOf(id));
    return votes == r.class_votes.end() ? 0 : votes->second / std::max(1, r.observations);
}

double Instances::SeenArea_m2(InstanceId id) const {
    return records_[id].area_m2 / std::max(1, records_[id].observations);
}

bool Instances::stands(InstanceId id) const {
    if (!confirmed(id)) return false;
    return records_[id].observations >=
           kStandingShare * config_.min_rate * records_[id].visible_frames;
}

std::vector<InstanceId> Instances::Match(const std::vector<ObservedObject>& observed,
                                         const std::map<InstanceId, VisibleObject>& visible,
                                         const ClassSet& not_sought) {
    std::vector<InstanceId> match(observed.size(), 0);
    Assign(observed, visible, match);
    const std::set<InstanceId> claimed(match.begin(), match.end());
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (match[i] != 0 || observed[i].pixels == 0) continue;
        int busy = 0;  // pixels held by instances that no detection of this frame explains
        for (const auto& [id, pixels] : observed[i].overlaps)
            if (!claimed.contains(id) && ClassOf(id) == observed[i].class_id) busy += pixels;
        if (busy < kFree * observed[i].pixels) match[i] = Add();
    }
    for (const auto& [id, seen] : visible) {
        const bool sought = !not_sought[static_cast<std::size_t>(ClassOf(id))];
        if ((sought && seen.pixels >= kLeastVisible) || std::ranges::find(match, id) != match.end())
            ++records_[id].visible_frames;
    }
    for (std::size_t i = 0; i < observed.size(); ++i)
        if (match[i] != 0) Update(match[i], observed[i], At(visible, match[i]).pixels);
    GatherEvidence(observed, visible, match);
    for (const InstanceId id : ids()) Judge(id);
    for (InstanceId& id : match) id = Resolve(id);
    return match;
}

// Greedy one-to-one assignment, best scores first.
void Instances::Assign(const std::vector<ObservedObject>& observed,
                       const std::map<InstanceId, VisibleObject>& visible,
                       std::vector<InstanceId>& match) const {
    struct Candidate {
        double fit;
        std::size_t detection;
        InstanceId id;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        for (const InstanceId id : ids())  // instances whose votes are still outvoted
            if (!visible.contains(id) && Resolve(id) == id && ClassOf(id) == observed[i].class_id)
                if (const double space = IntersectionOverUnion(observed[i].box, records_[id].box);
                    space >= kSameUnseen)
                    candidates.push_back({0.1 * space, i, id});
        for (const auto& [id, common] : observed[i].overlaps) {
            const double fit = Fit(observed[i], records_[id], common, At(visible, id),
                                   ClassOf(id) == observed[i].class_id);
            if (fit > 0) candidates.push_back({fit, i, id});
        }
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
    r.held += visible >= kHeldShare * observed.own_pixels;
    r.box.extend(observed.box);
    r.area_m2 += observed.area_m2;
    AddMarks({observed.mark}, r);
    AddEmbedding(observed.embedding, observed.probability, r);
}

// Confirms an instance after enough observations. Drops it if it is in view often enough without.
void Instances::Judge(InstanceId id) {
    InstanceRecord& r = records_[id];
    if (r.public_id > 0 || r.dropped || r.merged_into != 0) return;
    const double rate = static_cast<double>(r.observations) / std::max(1, r.visible_frames);
    const auto count = r.class_counts.find(ClassOf(id));
    const double share =
        count == r.class_counts.end() ? 0 : static_cast<double>(count->second) / r.observations;
    if (r.observations >= config_.min_observations && rate >= config_.min_rate &&
        share >= kClassShare && 2 * r.held >= r.observations)
        r.public_id = r.number_before > 0 ? r.number_before : ++last_public_;
    else if (r.visible_frames >= kTrialFrames && rate < config_.min_rate)
        r.dropped = true;
}

bool Instances::Covers(const ObservedObject& observed,
                       const std::map<InstanceId, VisibleObject>& visible, InstanceId id) const {
    const int pixels = At(visible, id).pixels;
    return pixels >= kLeastVisible && At(observed.overlaps, id) >= kCovers * pixels;
}

std::vector<InstanceId> Instances::Covered(const ObservedObject& observed,
                                           const std::map<InstanceId, VisibleObject>& visible,
                                           const std::vector<InstanceId>& match) const {
    std::vector<InstanceId> covered;
    for (const auto& [id, common] : observed.overlaps)
        if (std::ranges::find(match, id) == match.end() &&
            (ClassOf(id) == observed.class_id || stands(id)) && Covers(observed, visible, id))
            covered.push_back(id);
    return covered;
}

void Instances::GatherEvidence(const std::vector<ObservedObject>& observed,
                               const std::map<InstanceId, VisibleObject>& visible,
                               const std::vector<InstanceId>& match) {
    const auto key = [](InstanceId a, InstanceId b) {
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::set<std::pair<InstanceId, InstanceId>> together;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (match[i] == 0) continue;
        for (std::size_t j = 0; j < i; ++j)
            if (match[j] != 0 && ClassOf(match[j]) == ClassOf(match[i]))
                ++evidence_[key(match[i], match[j])].apart;
        if (!Covers(observed[i], visible, match[i])) continue;
        for (const auto& [id, common] : observed[i].overlaps)
            if (std::ranges::find(match, id) == match.end() && ClassOf(id) == ClassOf(match[i]) &&
                Covers(observed[i], visible, id))
                together.insert(key(id, match[i]));
    }
    for (const auto& pair : together) {
        PairEvidence& e = evidence_[pair];
        if (++e.together >= kTogether && e.together > kOftener * e.apart)
            Join(pair.first, pair.second);
    }
}

// Keeps the instance with the smaller public number, or else the older one.
void Instances::Join(InstanceId a, InstanceId b) {
    a = Resolve(a), b = Resolve(b);
    if (a == b || a == 0 || b == 0) return;
    const auto rank = [&](InstanceId id) {
        return std::pair(
            records_[id].public_id > 0 ? records_[id].public_id : std::numeric_limits<int>::max(),
            id);
    };
    if (rank(b) < rank(a)) std::swap(a, b);
    InstanceRecord &kept = records_[a], &gone = records_[b];
    for (const auto& [class_id, votes] : gone.class_votes) kept.class_votes[class_id] += votes;
    for (const auto& [class_id, count] : gone.class_counts) kept.class_counts[class_id] += count;
    kept.observations += gone.observations;
    kept.visible_frames = std::max(kept.visible_frames, gone.visible_frames);
    kept.box.extend(gone.box);
    kept.area_m2 += gone.area_m2;
    AddMarks(gone.marks, kept);
    AddEmbedding(gone.embedding, 1.0, kept);
    if (kept.number_before == 0) kept.number_before = gone.number_before;
    gone.merged_into = a;
}

}  // namespace tessera
