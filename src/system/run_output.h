// The folder that a run leaves: trajectory.txt and frames.csv grow frame by frame, so that a killed
// run loses at most its last lines; the rest is written at the end, each file whole or not at all.
// Owner thread only.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "core/mesh.h"
#include "core/status.h"
#include "system/labelling_stage.h"
#include "system/run.h"
#include "system/tracking_stage.h"

namespace tessera {

class RunOutput {
  public:
    // Makes the folder, removes what an earlier run left of the files below, and starts the growing
    // ones. run.json says "unfinished" until Finish.
    static Result<std::unique_ptr<RunOutput>> Open(const RunRequest& request,
                                                   const RunConfig& config,
                                                   const SourceInfo& source);

    // One line of frames.csv; one of trajectory.txt if the frame was tracked. Both reach the system
    // before return.
    Status AddFrame(const FrameReport& report, double decode_ms, double frame_ms);

    // The frame's lines in detections.txt, after a line that says that it was looked at.
    Status AddDetections(const LabelReport& report, const LabelClasses& classes);
    // Lines of trajectory.txt of frames that were tracked before this run.
    Status AddPath(const std::vector<StampedPose>& path);
    // trajectory.txt anew, from poses that are known better now; whole or not at all.
    Status ReplacePath(const std::vector<StampedPose>& path);

    // mesh.ply, and preview.png where the mesh has triangles: of a large one coarsened, and the
    // mesh itself gone by then. The first error, but the other file is tried, too.
    Status WriteMesh(TriangleMesh mesh) const;

    // objects.json, timings.json, run.json; likewise.
    Status Finish(const RunSummary& summary);

  private:
    struct FileCloser {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, FileCloser>;

    RunOutput(const RunRequest& request, const RunConfig& config)
        : request_(request), config_(config) {}
    std::string Path(const std::string& name) const { return request_.output_folder + "/" + name; }
    Status OpenGrowing(const std::string& name, const std::string& header, File& file);
    Status Append(const std::string& name, const std::string& line, File& file);
    Status WritePicture(const TriangleMesh& mesh) const;

    RunRequest request_;
    RunConfig config_;
    File trajectory_, frames_, detections_;  // the last one with labels only
    std::vector<Eigen::Isometry3d> path_;    // T_world_camera of the tracked frames
};

}  // namespace tessera
