#include "run/calibrate.h"

#include "io/frame_reader.h"
#include "run/open_source.h"

namespace tessera {

Result<Calibrated> CalibrateCamera(const CalibrateRequest& request, RunConfig config) {
    config.source.rectify = false;
    config.openni.calibration = "none";
    Result<std::unique_ptr<FrameSource>> source = OpenSource(request.source, config);
    if (!source.ok()) return source.status();
    const SourceInfo info = source.value()->info();
    if (!info.one_camera)
        return Status::Error(request.source +
                             ": depth and colour are of two cameras, which one board view cannot "
                             "calibrate; its own calibration is used");
    FrameReader reader(std::move(source.value()), {}, config.read_ahead);
    CameraCalibrator calibrator(request.board);
    Frame frame;
    while (request.stop == nullptr || !*request.stop) {
        const ReadResult read = reader.Next(frame);
        if (read.status == ReadStatus::kEnd) break;
        if (read.status == ReadStatus::kError) return Status::Error(read.message);
        if (read.status != ReadStatus::kOk || !calibrator.Add(frame)) continue;
        if (request.on_view) request.on_view(calibrator);
        if (info.live && calibrator.enough()) break;
    }
    Result<CalibrationResult> result = calibrator.Solve(info.depth_units_per_m);
    if (!result.ok()) return Status::Error(request.source + ": " + result.message());
    result.value().calibration.fps = info.fps;
    return Calibrated{result.value(), info.calibration_file};
}

}  // namespace tessera
