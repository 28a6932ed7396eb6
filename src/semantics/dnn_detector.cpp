#include "semantics/dnn_detector.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <utility>

#include "core/input_file.h"
#include "semantics/coco_names.h"
#include "semantics/yolo_outputs.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxModelBytes = std::size_t{2} << 30;
constexpr int kGreyPad = 114;  // all families are trained with this padding

std::string OneLine(const char* text) {
    std::string line(text);
    for (char& c : line)
        if (c == '\n' || c == '\r') c = ' ';
    return line.substr(0, 200);
}

class DnnDetector : public Detector {
  public:
    DnnDetector(std::string path, cv::dnn::Net net, const LabelConfig& config)
        : path_(std::move(path)),
          net_(std::move(net)),
          config_(config),
          output_names_(net_.getUnconnectedOutLayersNames()) {}

    // Finds an input size at which the network runs and its outputs are recognised.
    Status Try();
    Status SetNames(std::vector<std::string> names);

    Result<std::vector<Detection>> Detect(const Frame& frame) override;
    bool needs_colour() const override { return true; }
    // OpenCV's thread count applies to the whole process. Nothing else here uses OpenCV's threads
    // while frames arrive.
    void WorkInBackground() override { cv::setNumThreads(1); }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    void Run(const cv::Mat& rgb);
    cv::Mat InputOf(const cv::Mat& rgb);
    Detection ToFrame(const RawDetection& raw, int width, int height) const;

    std::string path_;
    cv::dnn::Net net_;
    LabelConfig config_;
    std::vector<cv::String> output_names_;
    std::vector<std::string> names_;
    YoloLayout layout_;
    std::vector<cv::Mat> blobs_;
    std::vector<OutputArray> outputs_;  // point into blobs_
    double scale_x_ = 1, scale_y_ = 1;  // input pixels per frame pixel
};

Status DnnDetector::Try() {
    const std::vector<int> sizes =
        config_.input_px > 0 ? std::vector<int>{config_.input_px} : std::vector<int>{416, 640, 320};
    std::string why;
    for (const int size : sizes) {
        layout_ = {};
        layout_.input_px = size;
        try {
            Run(cv::Mat::zeros(size, size, CV_8UC3));
        } catch (const cv::Exception& error) {
            why = fmt::format("does not run with an input of {} px ({})", size,
                              OneLine(error.err.c_str()));
            continue;
        }
        const Result<YoloLayout> layout = RecogniseOutputs(outputs_, size, config_.family);
        if (layout.ok()) {
            layout_ = layout.value();
            return Status::Ok();
        }
        why = layout.message();
    }
    return Status::Error(path_ + ": " + why + "; see labels.input_px and labels.family");
}

Status DnnDetector::SetNames(std::vector<std::string> names) {
    names_ = std::move(names);
    if (static_cast<int>(names_.size()) == layout_.classes) return Status::Ok();
    return Status::Error(
        fmt::format("{}: the network has {} classes, but {} has {} names; set labels.names to a "
                    "file with its class names",
                    path_, layout_.classes, config_.names.empty() ? "the COCO list" : config_.names,
                    names_.size()));
}

// Fills outputs_. Throws cv::Exception.
void DnnDetector::Run(const cv::Mat& rgb) {
    net_.setInput(InputOf(rgb));
    net_.forward(blobs_, output_names_);
    outputs_.clear();
    for (cv::Mat& blob : blobs_) {
        if (blob.type() != CV_32F || !blob.isContinuous()) blob.convertTo(blob, CV_32F);
        outputs_.push_back(
            {std::vector<int>(blob.size.p, blob.size.p + blob.dims), blob.ptr<float>()});
    }
}

// Letterboxes the image at the top left; for Darknet it stretches the image. YOLOX takes BGR in
// 0..255, the others RGB in 0..1.
cv::Mat DnnDetector::InputOf(const cv::Mat& rgb) {
    const int size = layout_.input_px;
    scale_x_ = static_cast<double>(size) / rgb.cols,
    scale_y_ = static_cast<double>(size) / rgb.rows;
    if (layout_.family != ModelFamily::kDarknet) scale_x_ = scale_y_ = std::min(scale_x_, scale_y_);
    const int width = std::clamp(static_cast<int>(std::lround(rgb.cols * scale_x_)), 1, size);
    const int height = std::clamp(static_cast<int>(std::lround(rgb.rows * scale_y_)), 1, size);
    cv::Mat canvas(size, size, CV_8UC3, cv::Scalar::all(kGreyPad));
    cv::resize(rgb, canvas(cv::Rect(0, 0, width, height)), cv::Size(width, height));
    const bool yolox = layout_.family == ModelFamily::kYolox;
    return cv::dnn::blobFromImage(canvas, yolox ? 1.0 : 1.0 / 255, cv::Size(), cv::Scalar(), yolox);
}

Detection DnnDetector::ToFrame(const RawDetection& raw, int width, int height) const {
    Detection d;
    d.name = names_[static_cast<std::size_t>(raw.class_index)];
    d.probability = raw.probability;
    // Pixel i reaches from the edge i to i + 1. A box that is narrower has one pixel.
    const auto pixels = [](double low, double high, int size) {
        const double last = size - 1, first = std::clamp(low, 0.0, last);
        return std::pair(static_cast<float>(first),
                         static_cast<float>(std::clamp(high - 1, first, last)));
    };
    const auto [x_min, x_max] = pixels(raw.x_min / scale_x_, raw.x_max / scale_x_, width);
    const auto [y_min, y_max] = pixels(raw.y_min / scale_y_, raw.y_max / scale_y_, height);
    d.box = {x_min, y_min, x_max, y_max};
    if (layout_.masks_output >= 0)
        d.mask = MaskOf(layout_, outputs_, raw, PixelsOf(d.box, width, height), scale_x_, scale_y_);
    return d;
}

Result<std::vector<Detection>> DnnDetector::Detect(const Frame& frame) {
    if (frame.colour.empty()) return Status::Error("labels: the frame has no colour image");
    // OpenCV has no Mat of const pixels. It only reads them here.
    const cv::Mat rgb(frame.colour.height(), frame.colour.width(), CV_8UC3,
                      const_cast<Rgb8*>(frame.colour.data()));
    try {
        Run(rgb);
    } catch (const cv::Exception& error) {
        return Status::Error(
            fmt::format("{}: failed while running: {}", path_, OneLine(error.err.c_str())));
    }
    std::vector<RawDetection> raw = DecodeOutputs(
        layout_, outputs_, std::max(0.01f, static_cast<float>(config_.min_probability)));
    SuppressOverlaps(static_cast<float>(config_.overlap), raw);
    std::vector<Detection> detections;
    for (const RawDetection& d : raw)
        detections.push_back(ToFrame(d, frame.colour.width(), frame.colour.height()));
    return detections;
}

Result<std::vector<std::string>> ReadNames(const std::string& path) {
    if (path.empty()) return CocoNames();
    const Result<std::string> text = ReadWholeFile(path, 1 << 20);
    if (!text.ok()) return text.status();
    std::vector<std::string> names;
    std::istringstream lines(text.value());
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (!line.empty()) names.push_back(line);
    }
    return names;
}

// Reads the file first: for a missing or damaged file OpenCV prints long messages to stderr.
Result<cv::dnn::Net> LoadNet(const std::string& path) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    const bool darknet = path.ends_with(".cfg") || path.ends_with(".weights");
    const std::string stem = std::filesystem::path(path).replace_extension().string();
    try {
        cv::dnn::Net net;
        if (darknet) {
            const Result<std::string> cfg = ReadWholeFile(stem + ".cfg", 1 << 24);
            if (!cfg.ok()) return cfg.status();
            const Result<std::string> weights = ReadWholeFile(stem + ".weights", kMaxModelBytes);
            if (!weights.ok()) return weights.status();
            net = cv::dnn::readNetFromDarknet(cfg.value().data(), cfg.value().size(),
                                              weights.value().data(), weights.value().size());
        } else {
            const Result<std::string> model = ReadWholeFile(path, kMaxModelBytes);
            if (!model.ok()) return model.status();
            if (model.value().empty()) return Status::Error(path + ": is empty");
            net = cv::dnn::readNetFromONNX(model.value().data(), model.value().size());
        }
        if (net.empty()) return Status::Error(path + ": contains no network");
        return net;
    } catch (const std::exception& error) {
        return Status::Error(
            path +
            ": OpenCV cannot read it; the file is damaged, truncated or not a supported network (" +
            OneLine(error.what()) + ")");
    }
}

}  // namespace

bool HasDnn() { return true; }

Result<std::unique_ptr<Detector>> OpenDnnDetector(const std::string& path,
                                                  const LabelConfig& config) {
    Result<std::vector<std::string>> names = ReadNames(config.names);
    if (!names.ok()) return names.status();
    Result<cv::dnn::Net> net = LoadNet(path);
    if (!net.ok()) return net.status();
    auto detector = std::make_unique<DnnDetector>(path, std::move(net.value()), config);
    if (Status status = detector->Try(); !status.ok()) return status;
    if (Status status = detector->SetNames(std::move(names.value())); !status.ok()) return status;
    return std::unique_ptr<Detector>(std::move(detector));
}

}  // namespace tessera
