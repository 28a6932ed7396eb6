// The cameras of a real Azure Kinect, as its recordings contain them: github.com/etiennedub/pyk4a,
// tests/assets/calibration.json, without the parts that are not read.
#pragma once

namespace tessera {

inline constexpr const char* kK4aDevice = R"({"CalibrationInformation": {"Cameras": [
{"Intrinsics": {"ModelParameterCount": 14, "ModelParameters": [
    0.51296979188919067, 0.51692354679107666, 0.4927808940410614, 0.49290284514427185,
    0.54793977737426758, -0.020971370860934258, -0.0026522316038608551, 0.88967907428741455,
    0.086130209267139435, -0.013910384848713875, 0, 0, -7.2104157879948616E-5,
    2.0557534298859537E-5], "ModelType": "CALIBRATION_LensDistortionModelBrownConrady"},
 "Location": "CALIBRATION_CameraLocationD0", "Purpose": "CALIBRATION_CameraPurposeDepth",
 "MetricRadius": 1.7399997711181641,
 "Rt": {"Rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "Translation": [0, 0, 0]},
 "SensorHeight": 1024, "SensorWidth": 1024},
{"Intrinsics": {"ModelParameterCount": 14, "ModelParameters": [
    0.49984714388847351, 0.50661760568618774, 0.47796511650085449, 0.63742393255233765,
    0.33012130856513977, -2.4893965721130371, 1.453670859336853, 0.20891207456588745,
    -2.302915096282959, 1.3751275539398193, 0, 0, -0.00012944525224156678,
    -0.00016178244550246745], "ModelType": "CALIBRATION_LensDistortionModelBrownConrady"},
 "Location": "CALIBRATION_CameraLocationPV0", "Purpose": "CALIBRATION_CameraPurposePhotoVideo",
 "MetricRadius": 0,
 "Rt": {"Rotation": [0.99999922513961792, 0.0011817576596513391, -0.00044814043212682009,
                     -0.0011387512786313891, 0.99628061056137085, 0.0861603245139122,
                     0.0005482942215166986, -0.086159750819206238, 0.9962812066078186],
        "Translation": [-0.032083429396152496, -0.0022053730208426714, 0.0038836926687508821]},
 "SensorHeight": 3072, "SensorWidth": 4096}]}})";

}  // namespace tessera
