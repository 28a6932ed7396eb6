#include "io/named_images.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>

#include "io/stamp_pairing.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits = "0123456789";

bool IsImageName(const std::string& name) {
    const std::string extension = fs::path(name).extension().string();
    constexpr std::array<std::string_view, 9> kExtensions = {
        ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG", ".ppm", ".pgm", ".tiff"};
    return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

// Sorted names of the images in a folder; empty if the folder cannot be read.
std::vector<std::string> ImageNames(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        std::string name = it->path().filename().string();
        if (name[0] != '.' && IsImageName(name)) names.push_back(std::move(name));
    }
    std::sort(names.begin(), names.end());
    return names;
}

// "1305031229.528748" is in seconds.
std::optional<double> StampInName(const std::string& name) {
    const std::string stem = fs::path(name).stem().string();
    if (stem.find('.') == std::string::npos) return StampOfDigits_s(stem);
    double value = 0;
    const auto [end, error] =
        std::from_chars(stem.data(), stem.data() + stem.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
    return value;
}

// The last run of digits in the name.
std::optional<std::int64_t> NumberInName(const std::string& name) {
    const std::string stem = fs::path(name).stem().string();
    const std::size_t last = stem.find_last_of(kDigits);
    if (last == std::string::npos) return std::nullopt;
    const std::size_t before = stem.find_last_not_of(kDigits, last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(stem.data() + first, stem.data() + last + 1, number);
    if (error != std::errc()) return std::nullopt;
    return number;
}

// Maps keys to names; nullopt unless every name has a key and all keys differ.
template <class Key>
std::optional<std::map<Key, std::string>> IndexNames(
    const std::vector<std::string>& names, std::optional<Key> (*key_of)(const std::string&)) {
    std::map<Key, std::string> index;
    for (const std::string& name : names) {
        const std::optional<Key> key = key_of(name);
        if (!key || !index.emplace(*key, name).second) return std::nullopt;
    }
    return index;
}

ImagePairs PairByStamp(const std::map<double, std::string>& depth,
                       const std::map<double, std::string>& colour, double max_gap_s,
                       double colour_delay_s) {
    const auto unzip = [](const std::map<double, std::string>& images,
                          std::vector<double>& stamps_s, std::vector<std::string>& names) {
        for (const auto& [stamp_s, name] : images) {
            stamps_s.push_back(stamp_s);
            names.push_back(name);
        }
    };
    std::vector<double> depth_s, colour_s;
    std::vector<std::string> depth_names, colour_names;
    unzip(depth, depth_s, depth_names);
    unzip(colour, colour_s, colour_names);
    ImagePairs result;
    for (const StampPair& pair :
         PairNearest(depth_s, colour_s, PairGap(max_gap_s, depth_s, colour_s), colour_delay_s))
        result.pairs.push_back({depth_s[pair.depth], colour_s[pair.colour], depth_names[pair.depth],
                                colour_names[pair.colour]});
    return result;
}

ImagePairs PairByNumber(const std::map<std::int64_t, std::string>& depth,
                        const std::map<std::int64_t, std::string>& colour, double fps) {
    ImagePairs result;
    for (const auto& [number, name] : depth) {
        const auto partner = colour.find(number);
        if (partner == colour.end()) continue;
        const double stamp_s = static_cast<double>(number) / fps;
        result.pairs.push_back({stamp_s, stamp_s, name, partner->second});
    }
    return result;
}

ImagePairs PairByOrder(const std::vector<std::string>& depth,
                       const std::vector<std::string>& colour, double fps) {
    ImagePairs result;
    if (depth.size() != colour.size()) return result;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const double stamp_s = static_cast<double>(i) / fps;
        result.pairs.push_back({stamp_s, stamp_s, depth[i], colour[i]});
    }
    return result;
}

void NoteUnpaired(std::size_t depth_count, std::size_t colour_count, ImagePairs& images) {
    const std::size_t pairs = images.pairs.size();
    if (pairs < depth_count || pairs < colour_count)
        images.notes.push_back(
            fmt::format("{} of {} depth and {} of {} colour images have no partner",
                        depth_count - pairs, depth_count, colour_count - pairs, colour_count));
}

}  // namespace

Result<ImagePairs> ReadSevenScenesNames(const std::string& folder, double fps) {
    std::vector<std::string> depth, colour;
    for (std::string& name : ImageNames(folder)) {
        if (!name.starts_with("frame-")) continue;
        if (name.ends_with(".depth.png"))
            depth.push_back(std::move(name));
        else if (name.ends_with(".color.png"))
            colour.push_back(std::move(name));
    }
    const auto depth_index = IndexNames(depth, &NumberInName);
    const auto colour_index = IndexNames(colour, &NumberInName);
    ImagePairs result;
    if (depth_index && colour_index) result = PairByNumber(*depth_index, *colour_index, fps);
    if (result.pairs.empty())
        return Status::Error(folder +
                             ": no frame-NNNNNN.color.png has a matching frame-NNNNNN.depth.png");
    result.listed = depth.size();
    NoteUnpaired(depth.size(), colour.size(), result);
    return result;
}

ImageFolders FindImageFolders(const std::string& folder) {
    ImageFolders found;
    std::error_code error;
    if (fs::is_directory(fs::path(folder) / "depth", error)) found.depth = "depth";
    for (const char* name : {"rgb", "colour", "color", "image", "images"})
        if (found.colour.empty() && fs::is_directory(fs::path(folder) / name, error))
            found.colour = name;
    return found;
}

Result<ImagePairs> PairByName(const std::string& folder, const ImageFolders& folders, double fps,
                              double max_gap_s, double colour_delay_s) {
    const std::vector<std::string> depth = ImageNames(fs::path(folder) / folders.depth);
    const std::vector<std::string> colour = ImageNames(fs::path(folder) / folders.colour);
    for (const auto& [name, images] :
         {std::pair(folders.depth, &depth), std::pair(folders.colour, &colour)})
        if (images->empty())
            return Status::Error((fs::path(folder) / name).string() + ": contains no images");

    const auto depth_stamps = IndexNames(depth, &StampInName),
               colour_stamps = IndexNames(colour, &StampInName);
    const auto depth_numbers = IndexNames(depth, &NumberInName),
               colour_numbers = IndexNames(colour, &NumberInName);
    ImagePairs result;
    if (depth_stamps && colour_stamps)
        result = PairByStamp(*depth_stamps, *colour_stamps, max_gap_s, colour_delay_s);
    else if (depth_numbers && colour_numbers)
        result = PairByNumber(*depth_numbers, *colour_numbers, fps);
    else
        result = PairByOrder(depth, colour, fps);
    if (result.pairs.empty())
        return Status::Error(
            fmt::format("{}: the {} images in {} and the {} in {} cannot be paired by name; give "
                        "matching images the same number, or write rgb.txt and depth.txt with "
                        "lines 'stamp filename'",
                        folder, depth.size(), folders.depth, colour.size(), folders.colour));
    result.listed = depth.size();
    NoteUnpaired(depth.size(), colour.size(), result);
    for (ImagePair& pair : result.pairs) {
        pair.depth = folders.depth + "/" + pair.depth;
        pair.colour = folders.colour + "/" + pair.colour;
    }
    return result;
}

}  // namespace tessera
