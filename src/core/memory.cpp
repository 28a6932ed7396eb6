#include "core/memory.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>
#include <sstream>

namespace tessera {
namespace {

constexpr double kMb = 1 << 20, kNoLimit = std::numeric_limits<double>::infinity();

std::atomic<double> limit_mb_of_process{0};

// The number in a file that holds nothing else; "max", or no such file: `otherwise`.
double NumberIn(const std::string& path, double otherwise) {
    double number = 0;
    return std::ifstream(path) >> number ? number : otherwise;
}

// The number after `key` in a file of lines "key number"; 0 if there is none.
double NumberAfter(const std::string& path, const std::string& key) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string word;
        double number = 0;
        if (words >> word >> number && word == key) return number;
    }
    return 0;
}

// What one control group leaves, in bytes. Pages of files that were not used lately can be given
// back at once.
double LeftIn(const std::string& folder, const char* limit, const char* usage,
              const char* inactive) {
    const double most = NumberIn(folder + "/" + limit, kNoLimit);
    if (most == kNoLimit) return kNoLimit;
    return most - NumberIn(folder + "/" + usage, 0) +
           NumberAfter(folder + "/memory.stat", inactive);
}

// Lines of /proc/self/cgroup: "0::/a/b" (version 2) or "7:memory:/a/b". In a container the folder
// may not be there; its own group is then the root.
double LeftInControlGroups(const std::string& root) {
    double left = kNoLimit;
    std::ifstream file(root + "/proc/self/cgroup");
    std::string line;
    while (std::getline(file, line)) {
        const bool second = line.starts_with("0::");
        const std::size_t name = line.find(":memory:");
        if (!second && name == std::string::npos) continue;
        const std::string top = root + "/sys/fs/cgroup" + (second ? "" : "/memory");
        std::string group = line.substr(second ? 3 : name + 8);
        while (true) {
            left = std::min(
                left, second ? LeftIn(top + group, "memory.max", "memory.current", "inactive_file")
                             : LeftIn(top + group, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                      "total_inactive_file"));
            if (group.empty()) break;
            group = group.substr(0, group.rfind('/'));
        }
    }
    return left;
}

double LeftOfOwnLimit(const std::string& root) {
    const double limit = kMb * limit_mb_of_process.load();
    if (limit <= 0) return kNoLimit;
    double pages = 0, resident = 0;
    std::ifstream(root + "/proc/self/statm") >> pages >> resident;
    return limit - resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

void SetMemoryLimit(double limit_mb) { limit_mb_of_process.store(limit_mb); }

double FreeMemoryMb(const std::string& root) {
    const double available = 1024 * NumberAfter(root + "/proc/meminfo", "MemAvailable:");
    return std::min({available > 0 ? available : kNoLimit, LeftInControlGroups(root),
                     LeftOfOwnLimit(root)}) /
           kMb;
}

bool MemoryHasRoomFor(std::size_t bytes) {
    constexpr double kSlack = 1.2, kReserve_mb = 256;
    return FreeMemoryMb() >= kSlack * static_cast<double>(bytes) / kMb + kReserve_mb;
}

}  // namespace tessera
