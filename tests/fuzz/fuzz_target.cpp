#include "fuzz/fuzz_target.h"

#include <sys/mman.h>
#include <unistd.h>

#include "core/printable.h"

namespace tessera::fuzz {

std::vector<FuzzTarget> FuzzTargets() {
    std::vector<FuzzTarget> all;
    for (const auto& some : {ImageTargets(), ModelTargets(), TextTargets(), ScanTargets(),
                             StateTargets(), RecordingTargets()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

BytesAsFile::BytesAsFile(std::span<const std::uint8_t> bytes)
    : file_(memfd_create("fuzz", MFD_CLOEXEC)), path_(fmt::format("/proc/self/fd/{}", file_)) {
    TESSERA_CHECK(file_ >= 0, "no file in memory");
    for (std::span<const std::uint8_t> rest = bytes; !rest.empty();) {
        const ssize_t written = write(file_, rest.data(), rest.size());
        TESSERA_CHECK(written > 0, "cannot write {} bytes", rest.size());
        rest = rest.subspan(static_cast<std::size_t>(written));
    }
}

BytesAsFile::~BytesAsFile() { close(file_); }

void CheckError(const Status& status, const std::string& path) {
    constexpr std::size_t kLongest = 2000;
    if (status.ok()) return;
    const std::string& text = status.message();
    TESSERA_CHECK(text.starts_with(path), "does not begin with the path: {}", text);
    TESSERA_CHECK(text.find('\n') == std::string::npos, "more than one line: {}", text);
    TESSERA_CHECK(text.size() < kLongest, "{} characters: {}", text.size(), text);
    TESSERA_CHECK(Printable(text) == text, "not printable: {}", Printable(text));
}

Bytes BytesOf(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace tessera::fuzz
