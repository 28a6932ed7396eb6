// The output folder of a run. trajectory.txt and frames.csv grow frame by frame, so that a killed
// run loses at most its last lines. Lines that find no room on the disk wait in memory, and are
// written with the next ones. The other files are written at the end, each completely or not at
// all. Owner thread only.
#pragma once

#include <memory>
#include <string>

#include "core/mesh.h"
#include "core/status.h"
#include "io/growing_file.h"
#include "run/run.h"
#include "system/labelling_stage.h"
#include "system/tracking_stage.h"

namespace tessera {

class RunOutput {
  public:
    // Creates the folder, removes an earlier run's files, and starts the growing ones. run.json
    // says "unfinished" until Finish. `classes`: those to label; empty without labels.
    static Result<std::unique_ptr<RunOutput>> Open(const RunRequest& request,
                                                   const RunConfig& config,
                                                   const SourceInfo& source,
                                                   const LabelClasses& classes);

    // Adds a line to frames.csv, and to trajectory.txt if the frame was tracked. An error says
    // which one has lines that wait.
    Status AddFrame(const FrameReport& report, double decode_ms, double frame_ms);

    // Begins detections.txt, in a run that was opened without labels.
    Status BeginDetections(const LabelClasses& classes);
    // Adds to detections.txt what another detector can find.
    Status AddClasses(const LabelClasses& classes);
    // Adds the frame's detections to detections.txt, after a line that marks the frame as
    // processed.
    Status AddDetections(const LabelReport& report, const LabelClasses& classes);
    // Adds lines to trajectory.txt for frames tracked before this run. Where the clock starts
    // again, the lines so far move to trajectory_1.txt and so on.
    Status AddPath(const std::vector<StampedPose>& path);
    // Keeps the path as tracked in trajectory_tracked.txt if the new one differs. Rewrites
    // trajectory.txt, and those of earlier clocks, with corrected poses, each completely
    // or not at all.
    Status ReplacePath(const std::vector<StampedPose>& path);

    // Writes mesh.ply, and preview.png if the mesh has triangles. Coarsens a large mesh for the
    // picture, after releasing the original. Tries both files and returns the first error.
    Status WriteMesh(TriangleMesh mesh) const;

    // Writes the lines that wait, objects.json, timings.json and run.json. Tries all and returns
    // the first error.
    Status Finish(const RunSummary& summary);

  private:
    struct Lines {
        GrowingFile file;
        std::string waiting;  // not written yet

        Status Append(const std::string& lines);
    };

    RunOutput(const RunRequest& request, const RunConfig& config)
        : request_(request), config_(config) {}
    std::string Path(const std::string& name) const { return request_.output_folder + "/" + name; }
    std::string EarlierPath(int clock) const;
    Status BeginClock();
    Status OpenGrowing(const std::string& name, const std::string& header, Lines& lines);
    Status WritePicture(const TriangleMesh& mesh) const;

    RunRequest request_;
    RunConfig config_;
    Lines trajectory_, frames_, detections_;  // detections_ with labels only
    std::vector<Eigen::Isometry3d> path_;     // T_world_camera of the tracked frames
    double last_stamp_s_ = 0;                 // of path_
    int clocks_ = 0;                          // files of earlier clocks
};

}  // namespace tessera
