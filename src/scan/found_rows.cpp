#include "scan/found_rows.h"

#include <fmt/format.h>

#include "scan/scan_file.h"

namespace tessera {

// Rows from an earlier epoch than the newest are leftovers.
std::vector<std::string> FoundRows::Index() {
    std::array<std::int64_t, kScanTableCount> epochs{};
    walk_->ForEach([&](const ScanRow& row, const PageWalk::Place& place) {
        ScanRows& found = rows_[IndexOf(row.table)];
        std::int64_t& epoch = epochs[IndexOf(row.table)];
        if (row.epoch < epoch) return;
        if (row.epoch > epoch) found.clear();
        epoch = row.epoch;
        const FoundRow version{row.checkpoint, place};
        const auto [at, fresh] = found.try_emplace(row.key, version);
        if (!fresh && at->second.checkpoint <= row.checkpoint) at->second = version;
    });
    ScanRow row;
    ScanSeal seal;
    if (!Load(ScanStateKey::kSeal, row) || !seal.Decode(row.data))
        return {"the number of rows per table"};
    std::vector<std::string> lost;
    for (const ScanTable table :
         {ScanTable::kBlocks, ScanTable::kPath, ScanTable::kFrames, ScanTable::kKeyframes}) {
        ScanRows& found = rows_[IndexOf(table)];
        const ScanSeal::Table& sealed = seal.tables[IndexOf(table)];
        if (epochs[IndexOf(table)] < sealed.epoch) found.clear();  // emptied since
        const auto missing = sealed.rows - static_cast<std::int64_t>(found.size());
        if (missing > 0)
            lost.push_back(fmt::format("{} of {} {}", missing, sealed.rows, ToString(table)));
    }
    return lost;
}

bool FoundRows::Load(ScanTable table, std::int64_t key, ScanRow& row) {
    const auto found = rows(table).find(key);
    return found != rows(table).end() && walk_->Load(found->second.place, row);
}

}  // namespace tessera
