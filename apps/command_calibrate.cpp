// tessera calibrate: a camera file from frames that show a printed board.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "command.h"
#include "config_options.h"
#include "io/file.h"
#include "run/calibrate.h"
#include "stop_signal.h"

namespace tessera {
namespace {

struct CalibrateArguments {
    CalibrateRequest request;
    double square_mm = 36;
    std::string out, print;
    bool force = false;
    ConfigOptions config;
};

void PrintResult(const CalibrationResult& result) {
    const CameraCalibration& c = result.calibration;
    fmt::print("{} views, corners off by {:.2f} pixels\n", result.views, result.rms_px);
    fmt::print(
        "fx {:.2f} +- {:.2f}, fy {:.2f} +- {:.2f}, cx {:.2f} +- {:.2f}, cy {:.2f} +- {:.2f}\n",
        c.pinhole.fx, result.fx_sigma_px, c.pinhole.fy, result.fy_sigma_px, c.pinhole.cx,
        result.cx_sigma_px, c.pinhole.cy, result.cy_sigma_px);
    if (result.depth_factor)
        fmt::print("depth is {:.4f} +- {:.4f} of the true distance; depth_scale {:.2f}\n",
                   1 / *result.depth_factor, result.depth_factor_sigma, c.depth_scale);
    else
        fmt::print("too little depth on the board: depth_scale {:g} is not checked\n",
                   c.depth_scale);
}

// Where --out says, or where the camera's calibration is looked for, or else camera.yaml. Does not
// replace a file without --force: the calibration is printed, and so is not lost.
Status Write(const CalibrateArguments& a, const Calibrated& calibrated) {
    const std::string text = CameraFileText(calibrated.result.calibration);
    const std::string path = !a.out.empty()             ? a.out
                             : !calibrated.file.empty() ? calibrated.file
                                                        : "camera.yaml";
    std::error_code ignored;
    if (!a.force && std::filesystem::exists(path, ignored)) {
        fmt::print("{}", text);
        return Status::Error(path + ": exists; --force replaces it, --out writes another file");
    }
    if (path == calibrated.file)
        std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
    Status written = WriteTextFile(path, text);
    if (written.ok())
        fmt::print("written: {}{}\n", path,
                   path == calibrated.file ? ", which is used for this camera from now on" : "");
    return written;
}

int Calibrate(CalibrateArguments& a) {
    a.request.board.square_m = a.square_mm / 1000;
    if (!a.print.empty()) {
        const Status written = WriteTextFile(a.print, a.request.board.Svg());
        if (written.ok())
            fmt::print(
                "{}: print it in true size (100 %), put it on something flat, and measure a "
                "square ({:g} mm)\n",
                a.print, a.square_mm);
        return ExitCode(written);
    }
    if (a.request.source.empty()) return Fail(Status::Error("SOURCE or --print is needed"));
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return Fail(status);
    if (Status status = config.Validate(); !status.ok()) return Fail(status);
    a.request.stop = &StopOnSignal();
    bool line_begun = false;
    if (isatty(STDERR_FILENO) == 1)
        a.request.on_view = [&](const CameraCalibrator& c) {
            fmt::print(stderr, "\rviews {}, corners in {:.0f} % of the image ", c.views(),
                       100 * c.coverage());
            line_begun = true;
        };
    const Result<Calibrated> calibrated = CalibrateCamera(a.request, config);
    a.request.on_view = {};
    if (line_begun) fmt::print(stderr, "\n");
    if (!calibrated.ok()) return Fail(calibrated.status());
    PrintResult(calibrated.value().result);
    return ExitCode(Write(a, calibrated.value()));
}

}  // namespace

void AddCalibrateCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<CalibrateArguments>();
    CLI::App* command = app.add_subcommand(
        "calibrate",
        "Estimate focal length, centre, lens distortion and depth unit from frames "
        "that show a printed board, and write a camera.yaml");
    command->add_option("SOURCE", a->request.source, "As for tessera run; it shows the board");
    command->add_option("--print", a->print, "Write the board for a printer instead")
        ->type_name("BOARD.svg");
    command
        ->add_option("--out", a->out,
                     "Camera file to write (default: for a camera with a serial number, the file "
                     "that is then used for it; otherwise camera.yaml)")
        ->type_name("FILE");
    command->add_flag("--force", a->force, "Replace the camera file");
    command->add_option("--columns", a->request.board.columns, "Squares in a row")
        ->check(CLI::Range(3, 14))
        ->capture_default_str();
    command->add_option("--rows", a->request.board.rows, "Rows of squares")
        ->check(CLI::Range(3, 14))
        ->capture_default_str();
    command->add_option("--square-mm", a->square_mm, "Width of a printed square, in millimetres")
        ->check(CLI::Range(5.0, 500.0))
        ->capture_default_str();
    a->config.AddTo(*command);
    command->callback([a, &context] { context.exit_code = Calibrate(*a); });
}

}  // namespace tessera
