// Recordings of the Azure Kinect (k4arecorder) and of cameras with its interface: Matroska files
// with a depth track, usually a colour track, and the cameras' calibration as an attachment.
// Source: github.com/microsoft/Azure-Kinect-Sensor-SDK, src/record, and "Azure Kinect recording
// file format" at learn.microsoft.com.
#pragma once

#include <string>

#include "recordings/recording.h"

namespace tessera {

// Time stamps are those of the device's clock. A depth image belongs to the colour image nearest in
// time, if that is less than 0.6 frames away. `colour_delay_s`: colour was taken so much later than
// its stamps say (PairNearest).
RecordingResult OpenMkv(const std::string& path, double colour_delay_s = 0);

}  // namespace tessera
