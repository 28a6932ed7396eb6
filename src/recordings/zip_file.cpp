#include "recordings/zip_file.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>

#include "core/input_file.h"

namespace tessera {
namespace {

struct CloseZipEntry {
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};

std::string ZipErrorText(int code) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    std::string text = zip_error_strerror(&error);
    zip_error_fini(&error);
    return text;
}

}  // namespace

void ZipFile::Close::operator()(zip* archive) const { zip_discard(archive); }

Result<ZipFile> ZipFile::Open(const std::string& path) {
    // libzip would wait for a pipe.
    if (Result<InputFile> file = InputFile::Open(path); !file.ok()) return file.status();
    int code = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY, &code);
    if (archive == nullptr)
        return Status::Error(
            fmt::format("{}: is not a ZIP archive, or it is damaged ({}); copy or "
                        "export it again",
                        path, ZipErrorText(code)));
    return ZipFile(archive);
}

std::size_t ZipFile::count() const {
    return static_cast<std::size_t>(
        std::max<zip_int64_t>(zip_get_num_entries(archive_.get(), 0), 0));
}

std::string_view ZipFile::Name(std::size_t index) const {
    const char* name = zip_get_name(archive_.get(), index, ZIP_FL_ENC_RAW);
    return name == nullptr ? std::string_view() : name;
}

Status ZipFile::Read(std::size_t index, std::size_t max_bytes, std::vector<std::uint8_t>& bytes) {
    zip_stat_t about;
    if (zip_stat_index(archive_.get(), index, 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0)
        return Status::Error("is damaged");
    if (about.size > max_bytes)
        return Status::Error(
            fmt::format("has {} bytes; at most {} bytes are read", about.size, max_bytes));
    const std::unique_ptr<zip_file_t, CloseZipEntry> file(
        zip_fopen_index(archive_.get(), index, 0));
    if (!file) return Status::Error(fmt::format("is damaged ({})", zip_strerror(archive_.get())));
    bytes.resize(static_cast<std::size_t>(about.size));
    std::size_t read = 0;
    while (read < bytes.size()) {
        const zip_int64_t got = zip_fread(file.get(), bytes.data() + read, bytes.size() - read);
        if (got <= 0) return Status::Error("is truncated or damaged");
        read += static_cast<std::size_t>(got);
    }
    // The checksum is compared at the end.
    std::uint8_t more;
    if (zip_fread(file.get(), &more, 1) != 0) return Status::Error("is damaged");
    return {};
}

}  // namespace tessera
