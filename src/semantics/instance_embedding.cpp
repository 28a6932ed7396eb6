// Embeddings of objects: means over their detections.
#include <algorithm>
#include <cmath>

#include "semantics/instances.h"

namespace tessera {

// Embeddings of another length than the first one cannot be compared with it and are ignored, as
// are those with a value that is not finite.
void Instances::AddEmbedding(const std::vector<double>& embedding, double weight,
                             InstanceRecord& record) {
    if (!std::ranges::all_of(embedding, [](double v) { return std::isfinite(v); })) return;
    if (record.embedding.empty()) record.embedding.resize(embedding.size());
    if (record.embedding.size() != embedding.size()) return;
    for (std::size_t i = 0; i < embedding.size(); ++i) record.embedding[i] += weight * embedding[i];
}

std::vector<float> Instances::Embedding(InstanceId id) const {
    double length2 = 0;
    for (const double v : records_[id].embedding) length2 += v * v;
    std::vector<float> unit;
    if (!(length2 > 0)) return unit;
    for (const double v : records_[id].embedding)
        unit.push_back(static_cast<float>(v / std::sqrt(length2)));
    return unit;
}

void Instances::SaveEmbeddings(StateWriter& state) const {
    if (std::ranges::all_of(records_, [](const auto& r) { return r.embedding.empty(); })) return;
    for (const InstanceRecord& r : records_) state.PutArray(std::span<const double>(r.embedding));
}

bool Instances::LoadEmbeddings(StateReader& state, std::vector<InstanceRecord>& records) {
    if (state.at_end()) return true;
    for (InstanceRecord& r : records)
        if (!state.GetArray(r.embedding)) return false;
    return state.at_end();
}

}  // namespace tessera
