#include "scan/page_walk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tessera {
namespace {

constexpr std::size_t kPage = kScanPageBytes;
constexpr std::size_t kJournalHeader = 32, kFrameHeader = 24;
constexpr std::size_t kNoPage = 0xffffffff;

std::uint32_t BigEndian(const std::uint8_t* bytes, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
    return value;
}

// Reads SQLite's variable-length integer. Returns false if the bytes end too early.
bool ReadVarint(std::span<const std::uint8_t> bytes, std::size_t& at, std::uint64_t& value) {
    value = 0;
    for (int i = 0; i < 9; ++i) {
        if (at >= bytes.size()) return false;
        const std::uint8_t byte = bytes[at++];
        if (i == 8) {
            value = value << 8 | byte;
            return true;
        }
        value = value << 7 | (byte & 0x7f);
        if (byte < 0x80) return true;
    }
    return true;
}

// Reads a column's value by its serial type; supports only integers, blobs and NULL.
bool ReadColumn(std::span<const std::uint8_t> record, std::size_t& at, std::uint64_t type,
                std::int64_t& number, std::span<const std::uint8_t>& blob) {
    constexpr std::size_t kIntegerBytes[] = {0, 1, 2, 3, 4, 6, 8};
    if (type == 8 || type == 9) {
        number = static_cast<std::int64_t>(type) - 8;
        return true;
    }
    if (type >= 1 && type <= 6) {
        const std::size_t size = kIntegerBytes[type];
        if (size > record.size() - at) return false;
        std::uint64_t value = (record[at] & 0x80) != 0 ? ~std::uint64_t{0} : 0;
        for (std::size_t i = 0; i < size; ++i) value = value << 8 | record[at + i];
        number = static_cast<std::int64_t>(value);
        at += size;
        return true;
    }
    if (type < 12 || type % 2 != 0) return type == 0;
    const std::uint64_t size = (type - 12) / 2;
    if (size > record.size() - at) return false;
    blob = record.subspan(at, static_cast<std::size_t>(size));
    at += static_cast<std::size_t>(size);
    return true;
}

}  // namespace

struct PageWalk::File {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
    ~File() {
        if (data != nullptr) ::munmap(const_cast<std::uint8_t*>(data), size);
    }
    Status Map(const std::string& path) {
        const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        struct stat what {};
        if (file < 0 || ::fstat(file, &what) != 0 || !S_ISREG(what.st_mode)) {
            const int error = file < 0 ? errno : EINVAL;
            if (file >= 0) ::close(file);
            return Status::Error(fmt::format("{}: cannot be read: {}", path, std::strerror(error)));
        }
        size = static_cast<std::size_t>(what.st_size);
        void* mapped = size > 0 ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
        ::close(file);
        if (mapped == MAP_FAILED) return Status::Error(path + ": cannot be mapped into memory");
        data = static_cast<const std::uint8_t*>(mapped);
        return Status::Ok();
    }
};

PageWalk::PageWalk() = default;
PageWalk::~PageWalk() = default;

Result<std::unique_ptr<PageWalk>> PageWalk::Open(const std::string& path) {
    std::unique_ptr<PageWalk> walk(new PageWalk());
    walk->files_.push_back(std::make_unique<File>());
    if (Status status = walk->files_[0]->Map(path); !status.ok()) return status;
    walk->main_pages_ = walk->files_[0]->size / kPage;
    for (std::size_t i = 0; i < walk->main_pages_; ++i)
        walk->images_.push_back({0, i * kPage, static_cast<std::uint32_t>(i + 1)});
    auto journal = std::make_unique<File>();
    if (journal->Map(path + "-wal").ok()) walk->AddJournal(std::move(journal));
    return walk;
}

// SQLite writes the journal again from its beginning, with a new salt: frames with another are
// remains. Those behind the last commit are of a checkpoint that was never completed.
void PageWalk::AddJournal(std::unique_ptr<File> journal) {
    constexpr std::size_t kFrame = kFrameHeader + kPage, kSalt = 8;
    const std::uint8_t* const data = journal->data;
    const auto is_current = [&](std::size_t at) {  // the first frame's, if the header is damaged
        return std::memcmp(data + at + 8, data + 16, kSalt) == 0 ||
               std::memcmp(data + at + 8, data + kJournalHeader + 8, kSalt) == 0;
    };
    std::size_t end = 0;
    for (std::size_t at = kJournalHeader; at + kFrame <= journal->size; at += kFrame) {
        const std::uint32_t pages_after_commit = BigEndian(data + at + 4, 4);  // 0: no commit
        if (is_current(at) && pages_after_commit != 0) end = at + kFrame;
    }
    for (std::size_t at = kJournalHeader; at < end; at += kFrame) {
        const std::uint32_t number = BigEndian(data + at, 4);
        if (number == 0 || number > (std::uint32_t{1} << 26)) continue;
        images_.push_back({1, at + kFrameHeader, number});
        if (newest_in_journal_.size() <= number) newest_in_journal_.resize(number + 1, 0);
        newest_in_journal_[number] = images_.size();
    }
    files_.push_back(std::move(journal));
}

std::span<const std::uint8_t> PageWalk::Page(const PageImage& image) const {
    return {files_[image.file]->data + image.offset, kPage};
}

void PageWalk::ForEach(const std::function<void(const ScanRow&, const Place&)>& take) {
    constexpr std::uint8_t kLeafOfTable = 0x0d;
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const std::span<const std::uint8_t> page = Page(images_[i]);
        const std::size_t header = images_[i].number == 1 ? 100 : 0;
        if (page[header] != kLeafOfTable) continue;
        const std::uint32_t cells = BigEndian(page.data() + header + 3, 2);
        for (std::size_t k = 0; k < cells && header + 8 + 2 * k + 2 <= kPage; ++k) {
            const Place place{i, BigEndian(page.data() + header + 8 + 2 * k, 2)};
            ScanRow row;
            if (Load(place, row)) take(row, place);
        }
    }
}

bool PageWalk::Load(const Place& place, ScanRow& row) {
    const PageImage& image = images_[place.image];
    const std::span<const std::uint8_t> page = Page(image);
    // A row may continue on overflow pages. Try the newest pages in the journal first. If they do
    // not belong to this row, use those in the file.
    return ReadCell(page, place.offset, true, row) || ReadCell(page, place.offset, false, row);
}

// Reads a leaf cell in SQLite's file format: size, key, the part of the record that fits, the
// number of the first overflow page.
bool PageWalk::ReadCell(std::span<const std::uint8_t> page, std::size_t at, bool journal,
                        ScanRow& row) {
    std::uint64_t size = 0, key = 0;
    if (at >= kPage || !ReadVarint(page, at, size) || !ReadVarint(page, at, key)) return false;
    if (size < 6 || size > kMaxRowBytes) return false;
    constexpr std::size_t kMostLocal = kPage - 35, kLeastLocal = (kPage - 12) * 32 / 255 - 23;
    std::size_t local = static_cast<std::size_t>(size);
    if (size > kMostLocal) {
        const std::size_t fitting =
            kLeastLocal + (static_cast<std::size_t>(size) - kLeastLocal) % (kPage - 4);
        local = fitting <= kMostLocal ? fitting : kLeastLocal;
    }
    if (local > kPage - at) return false;
    payload_.assign(page.begin() + static_cast<std::ptrdiff_t>(at),
                    page.begin() + static_cast<std::ptrdiff_t>(at + local));
    if (local < size) {
        if (at + local + 4 > kPage) return false;
        if (!GatherOverflow(BigEndian(page.data() + at + local, 4), journal,
                            static_cast<std::size_t>(size)))
            return false;
    }
    return ParseRecord(static_cast<std::int64_t>(key), row);
}

bool PageWalk::GatherOverflow(std::uint32_t number, bool journal, std::size_t size) {
    while (payload_.size() < size) {
        std::size_t image = kNoPage;
        if (number >= 1 && number <= main_pages_) image = number - 1;
        if (journal && number < newest_in_journal_.size() && newest_in_journal_[number] > 0)
            image = newest_in_journal_[number] - 1;
        if (image == kNoPage) return false;
        const std::span<const std::uint8_t> page = Page(images_[image]);
        const std::size_t take = std::min(size - payload_.size(), kPage - 4);
        const std::size_t at = payload_.size();
        payload_.resize(at + take);
        std::memcpy(payload_.data() + at, page.data() + 4, take);
        number = BigEndian(page.data(), 4);
    }
    return true;
}

// The checksum determines which table the row belongs to.
bool PageWalk::ParseRecord(std::int64_t key, ScanRow& row) {
    std::size_t at = 0;
    std::uint64_t header_size = 0, types[5] = {};
    const std::span<const std::uint8_t> record(payload_);
    if (!ReadVarint(record, at, header_size) || header_size > record.size()) return false;
    for (std::uint64_t& type : types)
        if (!ReadVarint(record.first(static_cast<std::size_t>(header_size)), at, type))
            return false;
    if (at != header_size) return false;
    std::int64_t nothing = 0, checksum = 0;
    std::span<const std::uint8_t> no_blob;
    row.data = {};
    if (types[0] != 0 || !ReadColumn(record, at, types[1], row.epoch, no_blob) ||
        !ReadColumn(record, at, types[2], row.checkpoint, no_blob) ||
        !ReadColumn(record, at, types[3], nothing, row.data) ||
        !ReadColumn(record, at, types[4], checksum, no_blob))
        return false;
    row.key = key;
    const auto fits = [&](ScanTable table) {
        row.table = table;
        return ChecksumOf(row) == static_cast<std::uint64_t>(checksum);
    };
    if (fits(last_table_)) return true;
    for (const ScanTable table : kScanTables)
        if (table != last_table_ && fits(table)) {
            last_table_ = table;
            return true;
        }
    return false;
}

}  // namespace tessera
