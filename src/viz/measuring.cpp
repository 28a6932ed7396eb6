#include "viz/measuring.h"

#include <filesystem>
#include <utility>

#include "io/file.h"

namespace tessera {

void Measuring::Open(const std::string& file) {
    file_ = file;
    trouble_.clear();
    may_save_ = !file.empty();
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) return;
    Result<std::vector<Measurement>> read = ReadMeasurements(file);
    if (read.ok()) {
        all_ = std::move(read.value());
        ++changes_;
    } else {
        trouble_ = read.message() + "; nothing will be saved";
        may_save_ = false;
    }
}

void Measuring::Toggle() {
    if (on_) Finish();
    on_ = !on_;
}

void Measuring::Click(const Eigen::Vector3d& p_world, bool on_first, bool raise) {
    cleared_.clear();
    if (raise && !all_.empty() && all_.back().closed) {
        all_.back().top = p_world;
        return Changed();
    }
    if (!is_open_) {
        all_.emplace_back();
        is_open_ = true;
    }
    Measurement& m = all_.back();
    if (on_first && m.corners.size() >= 3) {
        m.closed = true;
        is_open_ = false;
    } else {
        m.corners.push_back(p_world);
    }
    Changed();
}

void Measuring::TakeBack() {
    if (all_.empty()) {
        if (cleared_.empty()) return;
        all_ = std::exchange(cleared_, {});
        return Changed();
    }
    Measurement& m = all_.back();
    if (m.top) {
        m.top.reset();
    } else {
        if (!m.closed) m.corners.pop_back();
        m.closed = false;
        is_open_ = !m.corners.empty();
        if (!is_open_) all_.pop_back();
    }
    Changed();
}

void Measuring::Finish() {
    if (!is_open_) return;
    is_open_ = false;
    if (all_.back().corners.size() >= 2) return;
    all_.pop_back();
    Changed();
}

void Measuring::Clear() {
    Finish();
    if (all_.empty()) return;
    cleared_ = std::exchange(all_, {});
    Changed();
}

void Measuring::Changed() {
    ++changes_;
    if (!may_save_) return;
    std::span<const Measurement> complete(all_);
    if (!all_.empty() && all_.back().corners.size() < 2)
        complete = complete.first(complete.size() - 1);
    const Status status = WriteTextFile(file_, MeasurementsJson(complete));
    trouble_ = status.ok() ? "" : status.message();
}

std::string MeasurementsFile(const std::string& shown) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::is_regular_file(shown, ignored))
        return fs::path(shown).replace_extension(".measurements.json").string();
    return (fs::path(shown) / "measurements.json").string();
}

}  // namespace tessera
