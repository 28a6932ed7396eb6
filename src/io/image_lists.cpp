#include "io/image_lists.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <span>

#include "core/input_file.h"
#include "core/words.h"
#include "io/stamp_pairing.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxListBytes = std::size_t{256} << 20;  // two days at 30 Hz

constexpr double kLatestStamp_s = 1e12;  // 30,000 years; a larger number is not in seconds

struct ListedImage {
    double stamp_s;
    std::string name;
};

std::optional<double> ParseStamp(std::string_view word) {
    double stamp_s = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), stamp_s);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    if (std::abs(stamp_s) <= kLatestStamp_s) return stamp_s;
    return StampOfDigits_s(word);
}

// Passes each line's words to `use`, which returns whether they have the expected form. Reports in
// the notes how many do not.
Status ForEachLine(const std::string& path, const std::string& form,
                   const std::function<bool(std::span<const std::string_view>)>& use,
                   std::vector<std::string>& notes) {
    std::vector<std::uint8_t> bytes;
    if (Status status = ReadFileBytes(path, kMaxListBytes, bytes); !status.ok()) return status;
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // a byte order mark
    std::size_t bad = 0, first_bad = 0, good = 0;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const auto words = SplitWords(line.substr(0, line.find('#')), " \t\r,");
        if (words.empty()) continue;
        if (use(words)) {
            ++good;
        } else if (bad++ == 0) {
            first_bad = number;
        }
    }
    if (good == 0) return Status::Error(fmt::format("{}: no line of the form '{}'", path, form));
    if (bad > 0)
        notes.push_back(fmt::format("{}: {} line{} not of the form '{}' (first: line {}); skipped",
                                    path, bad, bad == 1 ? " is" : "s are", form, first_bad));
    return Status::Ok();
}

// Sorts by stamp and drops repeated stamps. `stamp` points to the member.
template <class Entry>
void SortByStamp(const std::string& path, double Entry::*stamp, std::vector<Entry>& entries,
                 std::vector<std::string>& notes) {
    const auto earlier = [stamp](const Entry& a, const Entry& b) { return a.*stamp < b.*stamp; };
    if (!std::is_sorted(entries.begin(), entries.end(), earlier)) {
        notes.push_back(path + ": stamps are out of order; sorted");
        std::stable_sort(entries.begin(), entries.end(), earlier);
    }
    const auto last =
        std::unique(entries.begin(), entries.end(),
                    [stamp](const Entry& a, const Entry& b) { return a.*stamp == b.*stamp; });
    const auto repeated = std::distance(last, entries.end());
    if (repeated == 0) return;
    notes.push_back(fmt::format("{}: {} stamp{} repeated; the first image of each is used", path,
                                repeated, repeated == 1 ? " is" : "s are"));
    entries.erase(last, entries.end());
}

Result<std::vector<ListedImage>> ReadList(const std::string& path, std::vector<std::string>& notes,
                                          std::size_t& listed) {
    std::vector<ListedImage> images;
    const auto use = [&](std::span<const std::string_view> words) {
        const auto stamp_s = ParseStamp(words[0]);
        if (!stamp_s || words.size() < 2) return false;
        // All that follows the stamp: names may contain blanks.
        images.push_back(
            {*stamp_s, std::string(words[1].data(), words.back().data() + words.back().size())});
        return true;
    };
    if (Status status = ForEachLine(path, "stamp filename", use, notes); !status.ok())
        return status;
    listed = images.size();
    SortByStamp(path, &ListedImage::stamp_s, images, notes);
    return images;
}

std::vector<double> Stamps(const std::vector<ListedImage>& images) {
    std::vector<double> stamps_s;
    for (const ListedImage& image : images) stamps_s.push_back(image.stamp_s);
    return stamps_s;
}

bool NamesDepth(std::string_view name) {
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return lower.find("depth") != std::string::npos;
}

}  // namespace

std::optional<double> StampOfDigits_s(std::string_view digits) {
    constexpr std::size_t kSecondsDigits = 10;  // from 2001 to 2286
    if ((digits.size() != 13 && digits.size() != 16 && digits.size() != 19) ||
        digits.front() == '0' || digits.find_first_not_of("0123456789") != std::string_view::npos)
        return std::nullopt;
    std::string decimal(digits);
    decimal.insert(kSecondsDigits, 1, '.');
    double stamp_s = 0;
    const auto parsed = std::from_chars(decimal.data(), decimal.data() + decimal.size(), stamp_s);
    TESSERA_CHECK(parsed.ec == std::errc(), "{}", decimal);
    return stamp_s;
}

Result<ImagePairs> ReadImageLists(const std::string& depth_list, const std::string& colour_list,
                                  double max_gap_s, double colour_delay_s) {
    ImagePairs result;
    std::size_t listed_colour = 0;
    const auto depth = ReadList(depth_list, result.notes, result.listed);
    if (!depth.ok()) return depth.status();
    const auto colour = ReadList(colour_list, result.notes, listed_colour);
    if (!colour.ok()) return colour.status();
    const std::vector<double> depth_s = Stamps(depth.value()), colour_s = Stamps(colour.value());
    max_gap_s = PairGap(max_gap_s, depth_s, colour_s);
    for (const StampPair& pair : PairNearest(depth_s, colour_s, max_gap_s, colour_delay_s)) {
        const ListedImage& d = depth.value()[pair.depth];
        const ListedImage& c = colour.value()[pair.colour];
        result.pairs.push_back({d.stamp_s, c.stamp_s, d.name, c.name});
    }
    if (result.pairs.empty())
        return Status::Error(fmt::format(
            "{}: no image is less than {:.3g} s from one in {} (the smallest gap is {:.6g} s); "
            "correct the stamps or raise max_pair_gap_s",
            depth_list, max_gap_s, colour_list, SmallestGap(depth_s, colour_s)));
    const std::size_t pairs = result.pairs.size();
    if (pairs < depth_s.size() || pairs < colour_s.size())
        result.notes.push_back(fmt::format(
            "{} of {} depth and {} of {} colour images have no partner less than {:.3g} s away",
            depth_s.size() - pairs, depth_s.size(), colour_s.size() - pairs, colour_s.size(),
            max_gap_s));
    return result;
}

Result<ImagePairs> ReadAssociations(const std::string& list) {
    ImagePairs result;
    const auto use = [&](std::span<const std::string_view> words) {
        if (words.size() < 4) return false;
        const auto first_s = ParseStamp(words[0]), second_s = ParseStamp(words[2]);
        const bool depth_first = NamesDepth(words[1]);
        if (!first_s || !second_s || depth_first == NamesDepth(words[3])) return false;
        ImagePair pair{*first_s, *second_s, std::string(words[1]), std::string(words[3])};
        if (!depth_first) {
            std::swap(pair.depth_stamp_s, pair.colour_stamp_s);
            std::swap(pair.depth, pair.colour);
        }
        result.pairs.push_back(std::move(pair));
        return true;
    };
    if (Status status = ForEachLine(list, "stamp depth/file stamp rgb/file", use, result.notes);
        !status.ok())
        return status;
    result.listed = result.pairs.size();
    SortByStamp(list, &ImagePair::depth_stamp_s, result.pairs, result.notes);
    return result;
}

bool StampsAreFrameNumbers(const std::vector<ImagePair>& pairs) {
    constexpr double kMostFrames = 1e7;
    return std::all_of(pairs.begin(), pairs.end(), [](const ImagePair& pair) {
        const double stamp = pair.depth_stamp_s;
        return stamp >= 0 && stamp < kMostFrames && stamp == std::floor(stamp);
    });
}

std::vector<std::string> StampWarnings(const ImagePairs& images) {
    std::vector<std::string> warnings;
    constexpr double kLongestPause_s = 60;
    const std::vector<ImagePair>& pairs = images.pairs;
    if (2 * pairs.size() < images.listed)
        warnings.push_back(fmt::format(
            "only {} of {} depth images {} used; are the time stamps right, and in seconds?",
            pairs.size(), images.listed, pairs.size() == 1 ? "is" : "are"));
    std::size_t leaps = 0, first = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i)
        if (pairs[i].depth_stamp_s - pairs[i - 1].depth_stamp_s > kLongestPause_s && leaps++ == 0)
            first = i;
    if (leaps > 0)
        warnings.push_back(fmt::format(
            "time stamps leap by more than {} s, {} time{} (first: by {:.6g} s before {})",
            kLongestPause_s, leaps, leaps == 1 ? "" : "s",
            pairs[first].depth_stamp_s - pairs[first - 1].depth_stamp_s, pairs[first].depth));
    return warnings;
}

}  // namespace tessera
