// The camera never waits: reading, tracking and mapping each run on their own thread, connected by
// bounded lock-free queues. The newest frame wins, and dropped frames are counted. With a device,
// the tracking thread also maps. docs/threads.md has the picture.
#pragma once

#include <thread>

#include "system/engine.h"
#include "system/live_reading.h"

namespace tessera {

class LiveEngine : public Engine {
  public:
    explicit LiveEngine(EngineInput input);
    ~LiveEngine() override;

    bool Next(FrameOutcome& outcome) override;
    const Status& status() const override { return status_; }
    void Stop() override { reading_.Stop(); }
    bool stopped() const override { return reading_.stopped(); }
    TriangleMesh TakeMesh() override;
    bool has_map() const override { return mapping_.life().stage().has_map(); }
    void Save(const ViewerCommand& command) override { mapping_.Save(command); }
    bool SendFinalMesh() override { return mapping_.life().SendFinalMesh(); }
    const std::vector<MapObject>& objects() const override {
        return mapping_.life().stage().objects();
    }
    MapStatistics map_statistics() const override {
        return StatisticsOf(mapping_.life().stage().blocks());
    }
    std::vector<StampedPose> CorrectedPath() const override;
    std::optional<CalibrationReport> calibration() const override;

  private:
    Status Start(EngineInput& input);
    void Run();

    LiveLinks links_;
    LiveReading reading_;
    LiveMapping mapping_;
    std::optional<LiveTracking> tracking_;
    Status status_;  // the reading thread's until it has ended
    std::atomic<bool> ended_{false};
    std::jthread reading_thread_;
};

}  // namespace tessera
