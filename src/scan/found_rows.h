// The newest intact version of each row of a damaged scan file.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scan/page_walk.h"

namespace tessera {

// A version of a row, and where it is.
struct FoundRow {
    std::int64_t checkpoint = 0;
    PageWalk::Place place;
};
using ScanRows = std::map<std::int64_t, FoundRow>;  // by key

// Owner thread only.
class FoundRows {
  public:
    explicit FoundRows(std::unique_ptr<PageWalk> walk) : walk_(std::move(walk)) {}

    // Visits the whole file. Call once, first. Returns how many rows are missing, for the user, one
    // item per table; empty if none are.
    std::vector<std::string> Index();

    const ScanRows& rows(ScanTable table) const { return rows_[IndexOf(table)]; }
    // Returns false if there is no such row. `row` is valid until the next Load.
    bool Load(ScanTable table, std::int64_t key, ScanRow& row);
    bool Load(ScanStateKey key, ScanRow& row) {
        return Load(ScanTable::kState, static_cast<std::int64_t>(key), row);
    }

  private:
    std::unique_ptr<PageWalk> walk_;
    std::array<ScanRows, kScanTableCount> rows_;
};

}  // namespace tessera
