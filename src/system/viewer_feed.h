// Feeds the window from the thread that owns the map: meshes, objects and pictures, as fast as the
// window takes them and no faster.
#pragma once

#include "system/mapping_stage.h"
#include "system/viewer_link.h"

namespace tessera {

// Owner thread only: the mapping stage's. Without a viewer it does nothing.
class ViewerFeed {
  public:
    // `mesh_blocks`: most blocks that one call may mesh.
    ViewerFeed(ViewerLink* viewer, int mesh_blocks) : viewer_(viewer), mesh_blocks_(mesh_blocks) {}

    // After a frame; returns the milliseconds that meshing took.
    double Send(const Frame& frame, const FrameReport& report, MappingStage& mapping);
    // Whether pictures of the map are wanted along with the frame.
    void ShowPrediction(bool on) { show_prediction_ = on; }

    // What changed since, of mesh and objects, also without a frame.
    double SendMesh(MappingStage& mapping);

  private:
    void SendObjects(const MappingStage& mapping);
    void SendImages(const Frame& frame, const FrameReport& report, const MappingStage& mapping);

    ViewerLink* viewer_;
    int mesh_blocks_;
    bool show_prediction_ = true;
    std::uint64_t objects_revision_ = 0;     // of the labels, when objects were last sent
    double stamp_s_ = 0;                     // of the last frame
    std::optional<double> objects_stamp_s_;  // when objects were last sent
};

}  // namespace tessera
