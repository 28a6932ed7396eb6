#include "io/trajectory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "core/input_file.h"
#include "io/file.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxTrajectoryBytes = std::size_t{256} << 20;  // a day at 30 Hz
constexpr std::size_t kMaxNotes = 50;
constexpr double kMaxCoordinate_m = 1e6;
constexpr std::size_t kColumns = 8;

// Collects notes; keeps the first kMaxNotes in full.
class Notes {
  public:
    explicit Notes(const std::string& path) : path_(path) {}
    void Add(std::size_t line, const std::string& why) {
        if (++count_ <= kMaxNotes) notes_.push_back(fmt::format("{}:{}: {}", path_, line, why));
    }
    std::vector<std::string> Take() {
        if (count_ > kMaxNotes)
            notes_.push_back(fmt::format("{}: and {} more such lines", path_, count_ - kMaxNotes));
        return std::move(notes_);
    }

  private:
    const std::string& path_;
    std::vector<std::string> notes_;
    std::size_t count_ = 0;
};

struct NumberLine {
    std::array<double, kColumns> values{};
    std::size_t count = 0;      // may exceed kColumns; further values are dropped
    std::string_view bad_word;  // the first word that is not a number
};

NumberLine ParseNumbers(std::string_view line) {
    constexpr std::string_view kSeparators = " \t\r,";
    NumberLine result;
    while (true) {
        const std::size_t begin = line.find_first_not_of(kSeparators);
        if (begin == std::string_view::npos) return result;
        line.remove_prefix(begin);
        std::string_view word = line.substr(0, line.find_first_of(kSeparators));
        line.remove_prefix(word.size());
        const char* first = word.data() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
        double value = 0;
        const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
        if (end != word.data() + word.size() || error == std::errc::invalid_argument) {
            result.bad_word = word;
            return result;
        }
        if (error == std::errc::result_out_of_range) value = std::nan("");
        if (result.count < kColumns) result.values[result.count] = value;
        ++result.count;
    }
}

// Returns why the pose cannot be used; empty if it can.
std::string ReadPose(const NumberLine& line, StampedPose& pose) {
    const auto& v = line.values;
    if (line.count != kColumns) return fmt::format("{} numbers, not 8; skipped", line.count);
    if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }))
        return "not a finite number; skipped";
    pose.stamp_s = v[0];
    const Eigen::Vector3d t(v[1], v[2], v[3]);
    if (!(t.cwiseAbs().maxCoeff() <= kMaxCoordinate_m))
        return "more than 1000 km from the origin; skipped";
    Eigen::Vector4d xyzw(v[4], v[5], v[6], v[7]);
    const double largest = xyzw.cwiseAbs().maxCoeff();
    if (largest < 1e-6) return "zero quaternion; skipped";
    xyzw /= largest;  // so that no square overflows
    pose.T_world_camera.setIdentity();
    pose.T_world_camera.linear() = Eigen::Quaterniond(xyzw.normalized()).toRotationMatrix();
    pose.T_world_camera.translation() = t;
    return {};
}

struct NumberedPose {
    StampedPose pose;
    std::size_t line;
};

void SortAndDropRepeated(std::vector<NumberedPose>& poses, Notes& notes, Trajectory& result) {
    const auto earlier = [](const NumberedPose& a, const NumberedPose& b) {
        return a.pose.stamp_s < b.pose.stamp_s;
    };
    const auto disorder = std::is_sorted_until(poses.begin(), poses.end(), earlier);
    if (disorder != poses.end())
        notes.Add(disorder->line, "stamps run backwards from here; sorted");
    std::stable_sort(poses.begin(), poses.end(), earlier);
    result.poses.reserve(poses.size());
    for (const NumberedPose& next : poses) {
        if (!result.poses.empty() && result.poses.back().stamp_s == next.pose.stamp_s)
            notes.Add(next.line, fmt::format("repeated stamp {:.6f}; skipped", next.pose.stamp_s));
        else
            result.poses.push_back(next.pose);
    }
}

}  // namespace

Result<Trajectory> ReadTrajectory(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, kMaxTrajectoryBytes);
    if (!text.ok()) return text.status();
    std::string_view rest = text.value();
    if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // a byte order mark

    Notes notes(path);
    std::vector<NumberedPose> poses;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const bool complete = end < rest.size();
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(complete ? end + 1 : end);
        line = line.substr(0, line.find('#'));
        const NumberLine parsed = ParseNumbers(line);
        if (!parsed.bad_word.empty() && complete)
            return Status::Error(
                fmt::format("{}:{}: '{}' is not a number; expected 'stamp tx ty tz qx qy qz qw' "
                            "(comments start "
                            "with #)",
                            path, number, Printable(parsed.bad_word, kQuotedBytes)));
        if (parsed.count == 0 && parsed.bad_word.empty()) continue;
        NumberedPose pose{{}, number};
        const std::string why =
            parsed.bad_word.empty() ? ReadPose(parsed, pose.pose) : "truncated line; skipped";
        if (why.empty())
            poses.push_back(pose);
        else
            notes.Add(number, why);
    }
    Trajectory result;
    SortAndDropRepeated(poses, notes, result);
    result.notes = notes.Take();
    if (result.poses.empty())
        return Status::Error(fmt::format(
            "{}: contains no pose; expected lines 'stamp tx ty tz qx qy qz qw'{}", path,
            result.notes.empty() ? "" : " (first problem: " + result.notes.front() + ")"));
    return result;
}

std::string TrajectoryLine(const StampedPose& pose) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    Eigen::Quaterniond q(pose.T_world_camera.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();  // pick the same sign every time
    return fmt::format("{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", pose.stamp_s,
                       t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

std::vector<std::vector<StampedPose>> SplitByClock(const std::vector<StampedPose>& poses) {
    std::vector<std::vector<StampedPose>> parts(1);
    for (const StampedPose& pose : poses) {
        if (!parts.back().empty() && StartsAgain(parts.back().back().stamp_s, pose.stamp_s))
            parts.emplace_back();
        parts.back().push_back(pose);
    }
    return parts;
}

std::string NumberedPath(const std::string& path, int number) {
    const std::filesystem::path whole(path);
    return (whole.parent_path() /
            fmt::format("{}_{}{}", whole.stem().string(), number, whole.extension().string()))
        .string();
}

Status WriteTrajectory(const std::string& path, const std::vector<StampedPose>& poses) {
    const auto parts = SplitByClock(poses);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::string text = "# stamp tx ty tz qx qy qz qw (T_world_camera; seconds, metres)\n";
        for (const StampedPose& pose : parts[i]) text += TrajectoryLine(pose) + '\n';
        const bool last = i + 1 == parts.size();
        if (Status status =
                WriteTextFile(last ? path : NumberedPath(path, static_cast<int>(i) + 1), text);
            !status.ok())
            return status;
    }
    return Status::Ok();
}

Status WriteKittiPoses(const std::string& path, const std::vector<StampedPose>& poses) {
    std::string lines, times;
    for (const StampedPose& pose : poses) {
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                lines += fmt::format("{:.9f} ", pose.T_world_camera(row, column));
        lines.back() = '\n';
        times += fmt::format("{:.6f}\n", pose.stamp_s);
    }
    if (Status status = WriteTextFile(path, lines); !status.ok()) return status;
    return WriteTextFile(path + ".times", times);
}

std::optional<Eigen::Isometry3d> InterpolatePose(const std::vector<StampedPose>& poses,
                                                 double stamp_s, double max_gap_s) {
    const auto after = std::lower_bound(
        poses.begin(), poses.end(), stamp_s,
        [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
    if (after == poses.end()) return std::nullopt;
    if (after->stamp_s == stamp_s) return after->T_world_camera;
    if (after == poses.begin()) return std::nullopt;
    const StampedPose& before = *(after - 1);
    const double gap_s = after->stamp_s - before.stamp_s;
    if (!(gap_s <= max_gap_s)) return std::nullopt;

    const double u = (stamp_s - before.stamp_s) / gap_s;
    const Eigen::Isometry3d& A = before.T_world_camera;
    const Eigen::Isometry3d& B = after->T_world_camera;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Quaterniond(A.linear())
                     .slerp(u, Eigen::Quaterniond(B.linear()))
                     .normalized()
                     .toRotationMatrix();
    T.translation() = (1 - u) * A.translation() + u * B.translation();
    return T;
}

std::optional<Eigen::Isometry3d> PoseAt(const std::vector<StampedPose>& poses, double stamp_s,
                                        double nearest_s) {
    if (auto T = InterpolatePose(poses, stamp_s)) return T;
    const auto after = std::ranges::lower_bound(poses, stamp_s, {}, &StampedPose::stamp_s);
    const StampedPose* nearest = nullptr;
    if (after != poses.begin()) nearest = &*(after - 1);
    if (after != poses.end() &&
        (nearest == nullptr || after->stamp_s - stamp_s < stamp_s - nearest->stamp_s))
        nearest = &*after;
    if (nearest == nullptr || !(std::abs(nearest->stamp_s - stamp_s) <= nearest_s))
        return std::nullopt;
    return nearest->T_world_camera;
}

}  // namespace tessera
