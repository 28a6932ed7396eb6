// Feeds the window from the thread that owns the map: meshes, objects and images, only as fast as
// the window takes them.
#pragma once

#include "system/mapping_stage.h"
#include "system/viewer_link.h"

namespace tessera {

// Owner thread only: the mapping stage's. Without a viewer, does nothing.
class ViewerFeed {
  public:
    // `mesh_blocks`: maximum number of blocks meshed per call.
    ViewerFeed(ViewerLink* viewer, int mesh_blocks) : viewer_(viewer), mesh_blocks_(mesh_blocks) {}

    // Call after each frame. Returns the meshing time in ms.
    double Send(const Frame& frame, const FrameReport& report, MappingStage& mapping);
    // Whether to send the predicted view of the map with the frame.
    void ShowPrediction(bool on) { show_prediction_ = on; }

    // Sends changes of the mesh and objects; also works without a frame.
    double SendMesh(MappingStage& mapping);
    // The run is paused: no frame comes.
    bool Paused() const { return viewer_ != nullptr && viewer_->paused.load(); }
    // It is, and SendMesh has more to send. ViewerLink::system is notified when that may have
    // become true.
    bool MeshWaits() const { return Paused() && waiting_ > 0 && HasRoom(); }

    // Call after the last frame and correction, until it returns true: sends the whole mesh anew, a
    // part each time, as the window takes it. False: more is to come.
    bool SendFinalMesh(MappingStage& mapping);

  private:
    bool HasRoom() const { return viewer_->meshes.size() < viewer_->meshes.capacity(); }
    void SendObjects(const MappingStage& mapping);
    void SendImages(const Frame& frame, const FrameReport& report, const MappingStage& mapping);

    ViewerLink* viewer_;
    int mesh_blocks_;
    int waiting_ = 0;  // blocks that SendMesh has left
    bool show_prediction_ = true;
    bool final_begun_ = false, final_sent_ = false;
    std::uint64_t objects_revision_ = 0;     // of the labels, when objects were last sent
    double stamp_s_ = 0;                     // of the last frame
    std::optional<double> objects_stamp_s_;  // when objects were last sent
};

}  // namespace tessera
