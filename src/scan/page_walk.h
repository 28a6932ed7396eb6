// Finds the rows of a scan file without SQLite, page by page: whatever its header, tables or trees
// look like, a row whose checksum is right is found. Reads the journal (-wal) beside it, too.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "scan/scan_row.h"

namespace tessera {

// Owner thread only.
class PageWalk {
  public:
    // Errors: the file cannot be read.
    static Result<std::unique_ptr<PageWalk>> Open(const std::string& path);
    ~PageWalk();
    PageWalk(const PageWalk&) = delete;
    PageWalk& operator=(const PageWalk&) = delete;

    // Where a row lies, for Load.
    struct Place {
        std::size_t image = 0, offset = 0;
    };
    // Every sound row, also those that are no longer part of the file; of one key perhaps several.
    void ForEach(const std::function<void(const ScanRow&, const Place&)>& take);
    // One that ForEach gave.
    bool Load(const Place& place, ScanRow& row);

  private:
    struct File;
    // A page as it is in the file or in the journal.
    struct PageImage {
        std::size_t file = 0;
        std::size_t offset = 0;
        std::uint32_t number = 0;
    };

    PageWalk();
    bool ReadCell(std::span<const std::uint8_t> page, std::size_t offset, bool journal,
                  ScanRow& row);
    bool GatherOverflow(std::uint32_t page, bool journal, std::size_t size);
    bool ParseRecord(std::int64_t key, ScanRow& row) const;
    std::span<const std::uint8_t> Page(const PageImage& image) const;

    std::vector<std::unique_ptr<File>> files_;
    std::vector<PageImage> images_;  // the file's by number, then the journal's in order
    std::size_t main_pages_ = 0;
    std::vector<std::size_t> newest_in_journal_;  // by page number: 1 + its image, 0 = none
    std::vector<std::uint8_t> payload_;           // of the last cell
    mutable ScanTable last_table_ = ScanTable::kBlocks;
};

}  // namespace tessera
