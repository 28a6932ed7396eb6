#include "recordings/record3d_metadata.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/quantile.h"

namespace tessera {
namespace {

// All numbers below each known key of the outermost object, in a row. Nothing else is kept, so
// that a hostile file takes no more memory than its numbers.
class R3dNumbers : public nlohmann::json_sax<nlohmann::json> {
  public:
    const std::vector<double>& operator[](const std::string& key) const {
        return numbers_.find(key)->second;
    }
    const std::string& error() const { return error_; }

    bool key(string_t& name) override {
        if (depth_ != 1) return true;
        const auto known = numbers_.find(name);
        current_ = known == numbers_.end() ? nullptr : &known->second;
        if (current_ != nullptr) current_->clear();
        return true;
    }
    bool number_integer(number_integer_t n) override { return Add(static_cast<double>(n)); }
    bool number_unsigned(number_unsigned_t n) override { return Add(static_cast<double>(n)); }
    bool number_float(number_float_t n, const string_t&) override { return Add(n); }
    bool start_object(std::size_t) override { return Enter(1); }
    bool end_object() override { return Enter(-1); }
    bool start_array(std::size_t) override { return Enter(1); }
    bool end_array() override { return Enter(-1); }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool parse_error(std::size_t byte, const std::string&,
                     const nlohmann::detail::exception&) override {
        error_ = fmt::format("is not valid JSON at byte {}", byte);
        return false;
    }

  private:
    bool Add(double number) {
        if (current_ != nullptr) current_->push_back(number);
        return true;
    }
    bool Enter(int levels) {
        depth_ += levels;
        return true;
    }

    std::map<std::string, std::vector<double>> numbers_ = {
        {"w", {}},   {"h", {}},
        {"dw", {}},  {"dh", {}},
        {"K", {}},   {"perFrameIntrinsicCoeffs", {}},
        {"fps", {}}, {"frameTimestamps", {}}};
    std::vector<double>* current_ = nullptr;
    long depth_ = 0;
    std::string error_;
};

// 0 if it is not given or no possible side of an image.
int R3dSide(const std::vector<double>& numbers) {
    const bool good = numbers.size() == 1 && numbers[0] >= 1 && numbers[0] <= 8192;
    return good ? static_cast<int>(numbers[0]) : 0;
}

// fx, fy, cx, cy: the median of each over all frames, or else from K, which has columns in a row.
std::array<double, 4> R3dIntrinsics(const R3dNumbers& numbers) {
    const std::vector<double>& k = numbers["K"];
    const std::vector<double>& frames = numbers["perFrameIntrinsicCoeffs"];
    if (frames.empty() || frames.size() % 4 != 0) return {k[0], k[4], k[6], k[7]};
    std::array<double, 4> medians{};
    for (std::size_t i = 0; i < 4; ++i) {
        std::vector<double> values;
        for (std::size_t at = i; at < frames.size(); at += 4) values.push_back(frames[at]);
        medians[i] = Median(values);
    }
    return medians;
}

}  // namespace

Result<Record3dMetadata> ParseRecord3dMetadata(std::string_view text) {
    R3dNumbers numbers;
    if (!nlohmann::json::sax_parse(text, &numbers)) return Status::Error(numbers.error());
    Record3dMetadata metadata;
    PinholeCamera& camera = metadata.colour_camera;
    camera.width = R3dSide(numbers["w"]);
    camera.height = R3dSide(numbers["h"]);
    if (camera.width == 0 || camera.height == 0)
        return Status::Error("has no size of colour images ('w' and 'h', 1 to 8192)");
    if (numbers["K"].size() != 9)
        return Status::Error(
            fmt::format("has {} numbers of the camera ('K') instead of 9", numbers["K"].size()));
    const std::array<double, 4> intrinsics = R3dIntrinsics(numbers);
    camera.fx = intrinsics[0];
    camera.fy = intrinsics[1];
    camera.cx = intrinsics[2];
    camera.cy = intrinsics[3];
    if (Status status = CheckPlausible(camera); !status.ok()) return status;
    metadata.depth_size = {R3dSide(numbers["dw"]), R3dSide(numbers["dh"])};
    const std::vector<double>& fps = numbers["fps"];
    if (fps.size() == 1 && fps[0] >= 0.1 && fps[0] <= 1000) metadata.fps = fps[0];
    metadata.stamps_s = numbers["frameTimestamps"];
    return metadata;
}

}  // namespace tessera
