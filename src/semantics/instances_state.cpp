#include <vector>

#include "semantics/instances.h"

namespace tessera {
namespace {

// False if Instances::Resolve would not end or would leave the records. A joined instance may be
// the older or the newer one.
bool MergesEnd(const std::vector<InstanceRecord>& records) {
    std::vector<bool> ends(records.size(), false);
    ends[0] = true;
    if (records[0].merged_into != 0) return false;
    for (std::size_t i = 1; i < records.size(); ++i) {
        std::size_t id = i;
        for (std::size_t steps = 0; !ends[id]; ++steps) {
            id = records[id].merged_into;
            if (id >= records.size() || steps == records.size()) return false;
        }
        for (id = i; !ends[id]; id = records[id].merged_into) ends[id] = true;
    }
    return true;
}

}  // namespace

void Instances::SaveState(StateWriter& state) const {
    state.Put(static_cast<std::uint64_t>(records_.size()));
    for (const InstanceRecord& r : records_) {
        state.Put(static_cast<std::uint64_t>(r.class_votes.size()));
        for (const auto& [id, sum] : r.class_votes) {
            state.Put(id);
            state.Put(sum);
            state.Put(r.class_counts.contains(id) ? r.class_counts.at(id) : 0);
        }
        for (const int value :
             {r.observations, r.visible_frames, r.held, r.public_id, r.number_before})
            state.Put(value);
        state.Put(r.area_m2);
        state.Put(static_cast<std::uint64_t>(r.marks.size()));
        for (const std::uint64_t mark : r.marks) state.Put(mark);
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
    SaveEmbeddings(state);
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
        for (int* value :
             {&r.observations, &r.visible_frames, &r.held, &r.public_id, &r.number_before})
            state.Get(*value);
        state.Get(r.area_m2);
        std::uint64_t marks = 0;
        state.Get(marks);
        for (; state.ok() && marks > 0; --marks) state.Get(r.marks.emplace_back());
        state.Get(r.merged_into);
        state.Get(r.dropped);
        bool empty = true;
        state.Get(empty);
        if (!empty && (!state.Get(r.box.min()) || !state.Get(r.box.max()))) return false;
        if (!state.ok()) return false;
    }
    if (!MergesEnd(records)) return false;
    std::map<std::pair<InstanceId, InstanceId>, PairEvidence> evidence;
    state.Get(count);
    for (; state.ok() && count > 0; --count) {
        std::pair<InstanceId, InstanceId> pair;
        PairEvidence found;
        if (!state.Get(pair.first) || !state.Get(pair.second) || !state.Get(found.together) ||
            !state.Get(found.apart))
            return false;
        if (pair.first >= records.size() || pair.second >= records.size()) return false;
        evidence[pair] = found;
    }
    int last_public = 0;
    if (!state.Get(last_public) || !LoadEmbeddings(state, records)) return false;
    last_public_ = last_public;
    records_ = std::move(records);
    evidence_ = std::move(evidence);
    return true;
}

}  // namespace tessera
