#include "report/report_data.h"

#include <filesystem>

#include "io/folder_layout.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

bool Exists(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

class Reader {
  public:
    explicit Reader(const std::string& folder) { data_.folder = folder; }

    // Calls read(path) and returns its value. A missing file is noted with what the page then does
    // not show.
    template <class Read>
    auto Optional(const std::string& name, const std::string& not_shown, Read read)
        -> std::optional<std::decay_t<decltype(read("").value())>> {
        const std::string path = data_.folder + "/" + name;
        if (!Exists(path)) {
            data_.left_out.push_back(fmt::format("No {}: {}.", name, not_shown));
            return std::nullopt;
        }
        auto result = read(path);
        if (result.ok()) return std::move(result.value());
        data_.damaged.push_back(result.message());
        return std::nullopt;
    }

    void ReadModel() {
        data_.mesh = Optional("mesh.ply", "the model is not shown", ReadPly);
        if (data_.mesh && data_.mesh->vertices.empty()) {
            data_.damaged.push_back(data_.folder + "/mesh.ply: has no vertices");
            data_.mesh.reset();
        }
        data_.path = Path("trajectory.txt", "the camera's path is not shown");
        if (Exists(data_.folder + "/trajectory_tracked.txt"))
            data_.tracked_path = Path("trajectory_tracked.txt", "");
        if (Exists(data_.folder + "/trajectory_1.txt"))
            data_.left_out.push_back(
                "The paths of earlier recordings (trajectory_1.txt, ...) are not shown.");
    }

    void ReadTables() {
        data_.frames =
            Optional("frames.csv", "tracking and times per frame are not shown", ReadFramesTable);
        if (data_.frames && !data_.frames->damage.empty())
            data_.damaged.push_back(data_.frames->damage);
        if (data_.frames && data_.frames->rows.empty()) {
            data_.left_out.push_back(
                "frames.csv has no frames: tracking and times per frame are not shown.");
            data_.frames.reset();
        }
        data_.record = Optional(
            "run.json", "source, settings, version and the command are not shown", ReadRunRecord);
        data_.times = Optional("timings.json", "speed and memory are not shown", ReadRunTimes);
        if (auto objects = Optional("objects.json", "objects are not shown", ReadObjects)) {
            data_.objects = std::move(*objects);
            if (data_.objects.empty()) data_.left_out.push_back("The run has no labelled objects.");
        }
    }

    Status ReadTruth(const std::string& given) {
        const bool must = !given.empty();
        Result<std::vector<StampedPose>> truth = TruePath(given);
        if (!truth.ok()) {
            if (must) return truth.status();
            data_.damaged.push_back(truth.message());
            return Status::Ok();
        }
        if (truth.value().empty()) {
            data_.left_out.push_back(
                "No ground truth at hand: the error of each frame is not shown (give --truth "
                "FILE).");
            return Status::Ok();
        }
        Result<AteResult> ate = EvaluateAte(truth.value(), data_.path);
        if (!ate.ok()) {
            const Status error = Status::Error(data_.truth + ": " + ate.message());
            if (must) return error;
            data_.damaged.push_back(error.message());
            return Status::Ok();
        }
        data_.ate = std::move(ate.value());
        Result<RpeResult> rpe = EvaluateRpe(truth.value(), data_.path);
        if (rpe.ok()) data_.rpe = std::move(rpe.value());
        return Status::Ok();
    }

    ReportData Take() { return std::move(data_); }
    const ReportData& data() const { return data_; }

  private:
    std::vector<StampedPose> Path(const std::string& name, const std::string& not_shown) {
        std::optional<Trajectory> path = Optional(name, not_shown, ReadTrajectory);
        if (!path) return {};
        for (const std::string& note : path->notes) data_.damaged.push_back(note);
        return std::move(path->poses);
    }

    // The true path, and in data_.truth where it comes from. Empty if there is none.
    Result<std::vector<StampedPose>> TruePath(const std::string& given) {
        data_.truth = given.empty() ? data_.folder + "/groundtruth.txt" : given;
        if (!given.empty() || Exists(data_.truth)) {
            Result<Trajectory> truth = ReadTrajectory(data_.truth);
            if (!truth.ok()) return truth.status();
            for (const std::string& note : truth.value().notes) data_.damaged.push_back(note);
            return std::move(truth.value().poses);
        }
        std::vector<StampedPose> poses;
        std::error_code ignored;
        if (!data_.record || !data_.record->has_truth ||
            !std::filesystem::is_directory(data_.record->source_name, ignored))
            return poses;
        data_.truth = data_.record->source_name;
        constexpr double kMaxPairGap_s = 0.02;
        const Result<FolderLayout> layout =
            ReadFolderLayout(data_.truth, kMaxPairGap_s, data_.record->colour_delay_s);
        if (!layout.ok()) return layout.status();
        for (const FolderFrame& frame : layout.value().frames)
            if (frame.T_world_camera) poses.push_back({frame.depth_stamp_s, *frame.T_world_camera});
        return poses;
    }

    ReportData data_;
};

}  // namespace

Result<ReportData> ReadReportData(const std::string& folder, const ReportOptions& options) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        return Status::Error(folder +
                             ": is not a folder; give the folder that tessera run --out "
                             "wrote");
    Reader reader(folder);
    reader.ReadModel();
    const ReportData& data = reader.data();
    if (!data.mesh && data.path.empty())
        return Status::Error(
            fmt::format("{}: {}; give the folder that tessera run --out wrote", folder,
                        data.damaged.empty() ? "has neither mesh.ply nor trajectory.txt"
                                             : data.damaged.front()));
    reader.ReadTables();
    if (!data.path.empty())
        if (Status status = reader.ReadTruth(options.truth); !status.ok()) return status;
    if (data.path.empty() && !options.truth.empty())
        return Status::Error(
            fmt::format("{}: has no readable trajectory.txt to compare with {}; leave --truth out",
                        folder, options.truth));
    return reader.Take();
}

}  // namespace tessera
