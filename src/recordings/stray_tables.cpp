#include "recordings/stray_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/input_file.h"

namespace tessera {
namespace {

constexpr std::size_t kMostStrayTableBytes = std::size_t{64} << 20;

std::string_view StrayTrimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\"";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// The part before the separator, which both leave `text`.
std::string_view TakeStrayPart(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    return part;
}

std::vector<std::string_view> StrayCells(std::string_view line) {
    constexpr std::size_t kMostCells = 64;
    std::vector<std::string_view> cells;
    while (!line.empty() && cells.size() < kMostCells)
        cells.push_back(StrayTrimmed(TakeStrayPart(line, ',')));
    return cells;
}

// The whole cell must be a finite number.
std::optional<double> StrayNumber(std::string_view cell) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

}  // namespace

Result<PinholeCamera> ReadStrayCamera(const std::string& path, int width, int height) {
    const Result<std::string> text = ReadWholeFile(path, kMostStrayTableBytes);
    if (!text.ok()) return text.status();
    const Status no_matrix = Status::Error(
        path +
        ": is no camera matrix, three lines of three numbers: fx, 0, cx; 0, fy, cy; 0, 0, 1");
    double k[3][3];
    std::string_view rest = text.value();
    for (auto& row : k) {
        std::string_view line;
        while (!rest.empty() && line.empty()) line = StrayTrimmed(TakeStrayPart(rest, '\n'));
        const std::vector<std::string_view> cells = StrayCells(line);
        if (cells.size() != 3) return no_matrix;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::optional<double> value = StrayNumber(cells[i]);
            if (!value) return no_matrix;
            row[i] = *value;
        }
    }
    constexpr double kRounding = 1e-3;
    if (std::abs(k[2][0]) + std::abs(k[2][1]) + std::abs(k[2][2] - 1) > kRounding) return no_matrix;
    const PinholeCamera camera{.width = width,
                               .height = height,
                               .fx = k[0][0],
                               .fy = k[1][1],
                               .cx = k[0][2],
                               .cy = k[1][2]};
    if (Status status = CheckPlausible(camera); !status.ok())
        return Status::Error(path + ": " + status.message());
    return camera;
}

std::vector<StrayStamp> ReadStrayStamps(const std::string& path) {
    std::vector<StrayStamp> stamps;
    const Result<std::string> text = ReadWholeFile(path, kMostStrayTableBytes);
    if (!text.ok()) return stamps;
    std::string_view rest = text.value();
    const std::vector<std::string_view> names = StrayCells(TakeStrayPart(rest, '\n'));
    const auto column = [&](std::string_view name) {
        return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    };
    const std::size_t stamp_at = column("timestamp"), frame_at = column("frame");
    if (std::max(stamp_at, frame_at) >= names.size()) return stamps;
    while (!rest.empty()) {
        const std::vector<std::string_view> cells = StrayCells(TakeStrayPart(rest, '\n'));
        if (cells.size() <= std::max(stamp_at, frame_at)) continue;
        const std::optional<double> stamp_s = StrayNumber(cells[stamp_at]);
        const std::optional<double> frame = StrayNumber(cells[frame_at]);
        constexpr double kMostFrameNumber = 1e12;
        if (stamp_s && frame && *frame >= 0 && *frame <= kMostFrameNumber)
            stamps.push_back({static_cast<std::uint64_t>(*frame), *stamp_s});
    }
    std::ranges::stable_sort(stamps, {}, &StrayStamp::frame);
    return stamps;
}

}  // namespace tessera
