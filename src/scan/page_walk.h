// Finds the rows of a scan file page by page, without SQLite. It finds every row whose checksum is
// right, whatever state the header, tables or trees are in. Also reads what is committed in the
// journal (-wal) next to the file.
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
    // It is an error if the file cannot be read.
    static Result<std::unique_ptr<PageWalk>> Open(const std::string& path);
    ~PageWalk();
    PageWalk(const PageWalk&) = delete;
    PageWalk& operator=(const PageWalk&) = delete;

    // Position of a row, for Load.
    struct Place {
        std::size_t image = 0, offset = 0;
    };
    // Visits every intact row, including rows that are no longer part of the file. There may be
    // several with the same key.
    void ForEach(const std::function<void(const ScanRow&, const Place&)>& take);
    // Loads a row that ForEach visited.
    bool Load(const Place& place, ScanRow& row);

  private:
    struct File;
    // A page as stored in the file or in the journal.
    struct PageImage {
        std::size_t file = 0;
        std::size_t offset = 0;
        std::uint32_t number = 0;
    };

    PageWalk();
    void AddJournal(std::unique_ptr<File> journal);
    bool ReadCell(std::span<const std::uint8_t> page, std::size_t offset, bool journal,
                  ScanRow& row);
    bool GatherOverflow(std::uint32_t page, bool journal, std::size_t size);
    bool ParseRecord(std::int64_t key, ScanRow& row);
    std::span<const std::uint8_t> Page(const PageImage& image) const;

    std::vector<std::unique_ptr<File>> files_;
    std::vector<PageImage> images_;  // the file's by number, then the journal's in order
    std::size_t main_pages_ = 0;
    std::vector<std::size_t> newest_in_journal_;  // by page number: 1 + image index, 0 = none
    std::vector<std::uint8_t> payload_;           // of the last cell
    ScanTable last_table_ = ScanTable::kBlocks;
};

}  // namespace tessera
