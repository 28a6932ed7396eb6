#include "finish/finish.h"

#include <tbb/task_group.h>

#include <algorithm>

#include "finish/decimate.h"
#include "finish/path_motion.h"
#include "finish/view_choice.h"

namespace tessera {
namespace {

constexpr std::size_t kFewestTriangles = 4;  // of a lower level
constexpr double kSampled = 0.05, kCleaned = 0.1, kSimplified = 0.15, kLaidOut = 0.2;  // shares

class Finisher {
  public:
    Finisher(const PinholeCamera& camera, std::span<const StampedPose> path,
             const FinishFrames& frames, const FinishOptions& options,
             const FinishProgress& progress)
        : camera_(camera), path_(path), frames_(frames), options_(options), progress_(progress) {}

    Result<FinishedModel> Finish(TriangleMesh mesh) {
        const Status cancelled = Status::Error("cancelled");
        finished_.report.triangles_before = mesh.triangles.size();
        if (mesh.normals.size() != mesh.vertices.size())
            return Status::Error("the mesh has no normals; repeat the run");
        const bool has_colours = !mesh.colours.empty();
        if (!has_colours) mesh.colours.assign(mesh.vertices.size(), Rgb8{180, 180, 180});
        const TriangleMesh scanned = mesh;  // its colours are the reference of the gains
        if (!CleanMesh(std::move(mesh))) return cancelled;
        if (finished_.surface.triangles.empty()) return Status::Error("the mesh has no triangles");
        if (!progress_("simplified", kSimplified)) return cancelled;
        if (Status status = LayOut(); !status.ok()) return status;
        if (!progress_("laid out", kLaidOut) || !Paint(has_colours ? &scanned : nullptr))
            return cancelled;
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            TexturedMesh level = levels_[i].Finish(finished_.report.levels[i]);
            if (i == 0)
                finished_.model = std::move(level);
            else
                finished_.lower_levels.push_back(std::move(level));
        }
        return std::move(finished_);
    }

  private:
    bool CleanMesh(TriangleMesh mesh) {
        FrameEvidence evidence;
        std::int64_t read = 0;
        const auto most =
            std::max<std::int64_t>(std::min(frames_.count, FrameEvidence::kMostFrames), 1);
        if (frames_.sample)
            for (Frame frame; frames_.sample(frame); ++read) {
                evidence.Add(camera_, frame);
                const double share = static_cast<double>(read) / static_cast<double>(most);
                if (!progress_("looked through", kSampled * std::min(share, 1.0))) return false;
            }
        finished_.report.evidence_frames = evidence.frames();
        CleanSurface surface =
            Clean(std::move(mesh), camera_, path_, evidence, options_.clean, finished_.report);
        finished_.filled = FilledPart(surface);
        if (!progress_("cleaned", kCleaned)) return false;
        const CleanOptions& o = options_.clean;
        LevelReport level;
        if (!surface.mesh.triangles.empty() && o.decimation_error_m > 0 && o.decimation_share < 1)
            level.error_m =
                Decimate(surface.mesh, surface.sigmas_m, o.decimation_error_m, o.decimation_share);
        finished_.report.levels.push_back(level);
        finished_.surface = std::move(surface.mesh);
        return true;
    }

    // The model and its lower levels.
    Status LayOut() {
        TriangleMesh mesh = finished_.surface;
        LevelOptions options = options_.texture;
        for (int i = 0;; ++i) {
            LevelReport& report = finished_.report.levels.back();
            Result<TexturedLevel> level =
                TexturedLevel::Make(mesh, camera_, path_, options, report);
            if (!level.ok()) return level.status();
            levels_.push_back(std::move(level.value()));
            if (i == options_.lower_levels) return Status::Ok();
            // Texels may be wider than asked for, so that they fit the texture.
            options.texel_m = 2 * report.texel_m;
            LevelReport lower;
            lower.error_m = report.error_m + DecimateTo(mesh, 0.25);
            if (mesh.triangles.size() < kFewestTriangles) return Status::Ok();
            finished_.report.levels.push_back(lower);
        }
    }

    // False: cancelled. `scanned`: the mesh whose colours the frames are made to match, or null.
    bool Paint(const TriangleMesh* scanned) {
        ViewChoice choice(path_, camera_);
        // Each view is painted while the next one is read and made.
        TextureView view;
        tbb::task_group painting;
        const auto paint = [&](const std::optional<Frame>& frame) {
            if (!frame) return;
            TextureView next = MakeTextureView(camera_, *frame, MotionOf(*frame));
            if (scanned != nullptr) EstimateGain(*scanned, next);
            painting.wait();
            view = std::move(next);
            painting.run([&] {
                for (TexturedLevel& level : levels_) level.Add(view);
            });
            ++finished_.report.views;
        };
        const auto candidates = static_cast<double>(choice.stamps_s().size());
        const NextPosedFrame next = frames_.at(choice.stamps_s());
        for (Frame frame; next(frame);) {
            const std::optional<std::size_t> number = choice.Find(frame);
            if (!number) continue;
            ++finished_.report.frames;
            if (frame.T_world_camera && !frame.colour.empty()) paint(choice.Offer(frame, *number));
            const double read = static_cast<double>(*number + 1) / candidates;
            if (!progress_("textured", kLaidOut + (1 - kLaidOut) * read)) {
                painting.wait();
                return false;
            }
        }
        paint(choice.Last());
        painting.wait();
        return true;
    }

    FrameMotion MotionOf(const Frame& frame) const {
        return {.twist_per_s = TwistAt(path_, frame.stamp_s),
                .colour_delay_s = frame.colour_stamp_s - frame.stamp_s,
                .depth_readout_s = frames_.depth_readout_s,
                .colour_readout_s = frames_.colour_readout_s};
    }

    const PinholeCamera& camera_;
    const std::span<const StampedPose> path_;
    const FinishFrames& frames_;
    const FinishOptions& options_;
    const FinishProgress& progress_;
    std::vector<TexturedLevel> levels_;
    FinishedModel finished_;
};

}  // namespace

Result<FinishedModel> FinishModel(TriangleMesh mesh, const PinholeCamera& camera,
                                  std::span<const StampedPose> path, const FinishFrames& frames,
                                  const FinishOptions& options, const FinishProgress& progress) {
    return Finisher(camera, path, frames, options, progress).Finish(std::move(mesh));
}

}  // namespace tessera
