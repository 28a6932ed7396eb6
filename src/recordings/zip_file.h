// Reads the files within a ZIP archive. Its content is not trusted.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/status.h"

struct zip;  // of libzip

namespace tessera {

// An open archive. Owner thread only.
class ZipFile {
  public:
    // Errors name the archive.
    static Result<ZipFile> Open(const std::string& path);

    // Of files within; each is known by its index.
    std::size_t count() const;
    std::string_view Name(std::size_t index) const;
    // A whole file (its storage is reused). It is an error if it has more than max_bytes, or if
    // its checksum is wrong. The error says what is wrong, without any name.
    Status Read(std::size_t index, std::size_t max_bytes, std::vector<std::uint8_t>& bytes);

  private:
    struct Close {
        void operator()(zip* archive) const;
    };
    explicit ZipFile(zip* archive) : archive_(archive) {}

    std::unique_ptr<zip, Close> archive_;
};

}  // namespace tessera
