// Keeps the numbers of objects when the map is rebuilt with corrected poses.
#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>

#include "semantics/instances.h"

namespace tessera {
namespace {

// Number of marks kept per instance. The smallest marks are a sample that does not depend on the
// order of the detections.
constexpr std::size_t kMarks = 64;

int CommonMarks(const InstanceRecord& a, const InstanceRecord& b) {
    std::vector<std::uint64_t> common;
    std::ranges::set_intersection(a.marks, b.marks, std::back_inserter(common));
    return static_cast<int>(common.size());
}

}  // namespace

void Instances::AddMarks(const std::vector<std::uint64_t>& marks, InstanceRecord& record) {
    std::vector<std::uint64_t> all;
    std::ranges::set_union(record.marks, marks, std::back_inserter(all));
    if (all.size() > kMarks) all.resize(kMarks);
    record.marks = std::move(all);
}

void Instances::KeepNumbersOf(const Instances& before) {
    std::vector<std::tuple<int, InstanceId, InstanceId>> pairs;  // (-shared marks, new id, old id)
    for (const InstanceId id : ids())
        for (const InstanceId old_id : before.ids())
            if (Resolve(id) == id && before.Resolve(old_id) == old_id && before.confirmed(old_id))
                if (const int common = CommonMarks(records_[id], before.records_[old_id]))
                    pairs.emplace_back(-common, id, old_id);
    std::ranges::sort(pairs);
    std::set<InstanceId> taken;
    for (InstanceRecord& r : records_) r.number_before = 0;
    for (const auto& [common, id, old_id] : pairs)
        if (records_[id].number_before == 0 && taken.insert(old_id).second)
            records_[id].number_before = before.records_[old_id].public_id;
    last_public_ = before.last_public_;
    for (InstanceRecord& r : records_)
        if (r.public_id > 0) r.public_id = r.number_before > 0 ? r.number_before : ++last_public_;
}

}  // namespace tessera
