#include "openni/device_feed.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "openni/test_pattern.h"

namespace tessera::test_device {
namespace {

class PatternFeed : public DeviceFeed {
  public:
    explicit PatternFeed(double rate_hz) : rate_hz_(rate_hz) {}
    int width() const override { return kWidth; }
    int height() const override { return kHeight; }
    double fx() const override { return kFocal_px; }
    double fy() const override { return kFocal_px; }

    void Get(int number, FeedFrame& frame) override {
        frame.stamp_us =
            static_cast<std::uint64_t>(1000000 + std::llround(1e6 * number / rate_hz_));
        frame.depth_mm.resize(kWidth * kHeight);
        frame.rgb.resize(3 * kWidth * kHeight);
        std::size_t at = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x, ++at) {
                frame.depth_mm[at] = PatternDepth(number, x, y);
                for (int channel = 0; channel < 3; ++channel)
                    frame.rgb[3 * at + static_cast<std::size_t>(channel)] =
                        PatternColour(number, x, y, channel);
            }
    }

  private:
    double rate_hz_;
};

struct Listed {
    double stamp_s;
    std::string path;
};

std::vector<Listed> ReadList(const std::string& folder, const char* name) {
    std::vector<Listed> list;
    std::ifstream file(folder + "/" + name);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        Listed entry;
        if (line.starts_with('#') || !(words >> entry.stamp_s >> entry.path)) continue;
        entry.path = folder + "/" + entry.path;
        list.push_back(entry);
    }
    return list;
}

class FolderFeed : public DeviceFeed {
  public:
    // Returns an empty string or the error.
    std::string Open(const std::string& folder, int preload) {
        depth_ = ReadList(folder, "depth.txt");
        colour_ = ReadList(folder, "rgb.txt");
        if (depth_.size() < 2 || colour_.empty())
            return "no images listed in depth.txt and rgb.txt";
        std::ifstream camera(folder + "/camera.yaml");
        for (std::string key; camera >> key;) {
            double* const value = key == "fx:"            ? &fx_
                                  : key == "fy:"          ? &fy_
                                  : key == "depth_scale:" ? &depth_scale_
                                                          : nullptr;
            if (value != nullptr) camera >> *value;
        }
        const cv::Mat first = cv::imread(depth_[0].path, cv::IMREAD_UNCHANGED);
        if (first.type() != CV_16UC1 || first.empty())
            return "no 16-bit depth image " + depth_[0].path;
        width_ = first.cols;
        height_ = first.rows;
        kept_.resize(std::min(static_cast<std::size_t>(std::max(preload, 0)), depth_.size()));
        for (std::size_t i = 0; i < kept_.size(); ++i) Decode(i, kept_[i]);
        return {};
    }
    int width() const override { return width_; }
    int height() const override { return height_; }
    double fx() const override { return fx_; }
    double fy() const override { return fy_; }

    void Get(int number, FeedFrame& frame) override {
        const auto last = static_cast<int>(depth_.size()) - 1;
        const int lap = number / last, step = number % last;
        const auto shown = static_cast<std::size_t>(lap % 2 == 0 ? step : last - step);
        if (shown < kept_.size())
            frame = kept_[shown];
        else
            Decode(shown, frame);
        // On the way back the time gaps come in reverse order.
        const double lap_s = depth_.back().stamp_s - depth_.front().stamp_s;
        const double into_lap_s = lap % 2 == 0 ? depth_[shown].stamp_s - depth_.front().stamp_s
                                               : depth_.back().stamp_s - depth_[shown].stamp_s;
        frame.stamp_us =
            static_cast<std::uint64_t>(1000000 + std::llround(1e6 * (lap * lap_s + into_lap_s)));
    }

  private:
    void Decode(std::size_t index, FeedFrame& frame) const {
        const std::size_t pixels =
            static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        frame.depth_mm.assign(pixels, 0);
        frame.rgb.assign(3 * pixels, 0);
        const cv::Mat depth = cv::imread(depth_[index].path, cv::IMREAD_UNCHANGED);
        if (depth.type() == CV_16UC1 && depth.total() == pixels)
            std::transform(
                depth.begin<std::uint16_t>(), depth.end<std::uint16_t>(), frame.depth_mm.begin(),
                [&](std::uint16_t stored) {
                    return static_cast<std::uint16_t>(std::lround(1000.0 * stored / depth_scale_));
                });
        const auto nearest = std::ranges::min_element(colour_, {}, [&](const Listed& c) {
            return std::abs(c.stamp_s - depth_[index].stamp_s);
        });
        const cv::Mat bgr = cv::imread(nearest->path, cv::IMREAD_COLOR);
        cv::Mat rgb(height_, width_, CV_8UC3, frame.rgb.data());
        if (bgr.size() == rgb.size()) cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    }

    std::vector<Listed> depth_, colour_;
    std::vector<FeedFrame> kept_;
    double fx_ = 525, fy_ = 525, depth_scale_ = 5000;
    int width_ = 0, height_ = 0;
};

}  // namespace

std::unique_ptr<DeviceFeed> MakePatternFeed(double rate_hz) {
    return std::make_unique<PatternFeed>(rate_hz);
}

std::unique_ptr<DeviceFeed> MakeFolderFeed(const std::string& folder, int preload) {
    auto feed = std::make_unique<FolderFeed>();
    const std::string trouble = feed->Open(folder, preload);
    if (trouble.empty()) return feed;
    std::fprintf(stderr, "test driver: %s: %s\n", folder.c_str(), trouble.c_str());
    return nullptr;
}

}  // namespace tessera::test_device
