#include "report/frames_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/input_file.h"

namespace tessera {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

// Fields between commas; a quoted one may contain commas.
std::vector<std::string_view> Fields(std::string_view line) {
    std::vector<std::string_view> fields;
    bool quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') quoted = !quoted;
        if (i < line.size() && (quoted || line[i] != ',')) continue;
        std::string_view field = line.substr(begin, i - begin);
        if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
            field = field.substr(1, field.size() - 2);
        fields.push_back(field);
        begin = i + 1;
    }
    return fields;
}

bool ToNumber(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

struct NumberColumn {
    const char* name;
    double FrameRow::*value;
    bool optional = false;
};
constexpr std::array kNumbers{NumberColumn{"stamp_s", &FrameRow::stamp_s},
                              NumberColumn{"inlier_fraction", &FrameRow::inlier_fraction},
                              NumberColumn{"distance_rms_m", &FrameRow::distance_rms_m, true},
                              NumberColumn{"decode_ms", &FrameRow::decode_ms, true},
                              NumberColumn{"prepare_ms", &FrameRow::prepare_ms},
                              NumberColumn{"track_ms", &FrameRow::track_ms},
                              NumberColumn{"moving_ms", &FrameRow::moving_ms},
                              NumberColumn{"allocate_ms", &FrameRow::allocate_ms},
                              NumberColumn{"fuse_ms", &FrameRow::fuse_ms},
                              NumberColumn{"frame_ms", &FrameRow::frame_ms}};

class Columns {
  public:
    explicit Columns(const std::vector<std::string_view>& header) : header_(header) {}

    // The first column that is missing; nullptr if there are all.
    const char* Missing() const {
        for (const char* name : {"index", "status", "fused", "degenerate", "method", "reason"})
            if (Find(name) == header_.size()) return name;
        for (const NumberColumn& column : kNumbers)
            if (!column.optional && !Has(column)) return column.name;
        return nullptr;
    }
    // Returns what is wrong with the line; empty if it was read.
    std::string Read(const std::vector<std::string_view>& fields, FrameRow& row) const {
        if (fields.size() != header_.size())
            return fmt::format("{} values instead of {}", fields.size(), header_.size());
        for (const NumberColumn& column : kNumbers)
            if (Has(column) && !ToNumber(fields[Find(column.name)], row.*column.value))
                return fmt::format("{} is not a number", column.name);
        double index = 0;
        if (!ToNumber(fields[Find("index")], index) || std::abs(index) > 1e15)
            return "index is not a number";
        row.index = static_cast<std::int64_t>(index);
        const std::string_view status = fields[Find("status")];
        if (status != "good" && status != "poor" && status != "lost")
            return "status is not good, poor or lost";
        row.state = status == "lost"               ? FrameState::kLost
                    : fields[Find("fused")] == "1" ? FrameState::kFused
                                                   : FrameState::kTracked;
        row.degenerate = fields[Find("degenerate")] == "1";
        row.method = fields[Find("method")];
        row.reason = fields[Find("reason")];
        return {};
    }

  private:
    bool Has(const NumberColumn& column) const { return Find(column.name) < header_.size(); }
    std::size_t Find(std::string_view name) const {
        return static_cast<std::size_t>(std::ranges::find(header_, name) - header_.begin());
    }

    std::vector<std::string_view> header_;
};

}  // namespace

Result<FramesTable> ReadFramesTable(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    if (!text.ok()) return text.status();
    std::string_view rest = text.value();
    std::int64_t number = 0, bad = 0;
    const auto next_line = [&] {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++number;
        return line;
    };
    const Columns columns(Fields(next_line()));
    if (const char* missing = columns.Missing(); missing != nullptr)
        return Status::Error(
            fmt::format("{}: its first line does not name the column {}; is it "
                        "the frames.csv of a run?",
                        path, missing));
    FramesTable table;
    while (!rest.empty()) {
        FrameRow row;
        const std::string wrong = columns.Read(Fields(next_line()), row);
        if (wrong.empty())
            table.rows.push_back(std::move(row));
        else if (++bad == 1)
            table.damage = fmt::format("{}:{}: {}", path, number, wrong);
    }
    if (bad == 1) table.damage += "; this line is left out";
    if (bad > 1) table.damage += fmt::format("; {} such lines are left out", bad);
    return table;
}

}  // namespace tessera
