#include "run/source_camera.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "io/corrected_depth.h"
#include "run/first_seconds.h"
#include "run/kept_source.h"
#include "run/open_source.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

// Of the focal length; beyond this the scan is of another camera.
constexpr double kOtherCamera = 0.25;
// Vignetting beyond this is estimated once more on the corrected images: the first estimate is a
// few percent of itself too small. A second look takes as long as the first, up to 2 s.
constexpr double kLookAgain = 0.12;

// A file or folder of images. Not a scan, a scene or a camera.
bool IsFileOrFolder(const std::string& name) {
    std::error_code ignored;
    return std::filesystem::exists(name, ignored) && !name.ends_with(".scan");
}

// The settings with `camera` instead of the given one.
RunConfig WithCamera(RunConfig config, const std::optional<PinholeCamera>& camera) {
    if (camera) UseCamera(*camera, config);
    return config;
}

// The scan's own camera, if it differs slightly from the source's.
std::optional<PinholeCamera> CameraOfScan(const std::string& path, const PinholeCamera& given) {
    const Result<ScanMeta> meta = ReadScanMeta(path);
    if (!meta.ok()) return std::nullopt;
    const PinholeCamera& was = meta.value().camera;
    if (was == given || was.width != given.width || was.height != given.height) return std::nullopt;
    if (std::abs(was.fx / given.fx - 1) > kOtherCamera) return std::nullopt;
    return was;
}

// OpenNI registers and pairs its images by itself.
bool IsOni(const std::string& name) { return name.ends_with(".oni"); }

void Describe(const SourceInfo& given, const std::optional<CameraReport>& report,
              std::vector<std::string>& messages) {
    const std::string assumed =
        fmt::format("assuming {}, fx {:.1f}", given.camera_from, given.camera.fx);
    const bool oni = IsOni(given.name);
    const char* none = oni ? "the device says no focal length" : "no camera.yaml";
    if (!report) {
        if (!given.camera_known)
            messages.push_back(
                fmt::format("{}, and the focal length cannot be estimated from this recording: {}",
                            none, assumed));
        return;
    }
    const CameraEstimate& e = report->estimate;
    if (!given.camera_known)
        messages.push_back(fmt::format(
            "{}: the estimate from this recording is fx {:.1f} +- {:.1f}{}", none, e.found.fx,
            e.focal_sigma_px,
            report->used ? fmt::format(", which is used; {} if you know better",
                                       oni ? "set source.openni.fx and fy" : "add a camera.yaml")
                         : ", which is too uncertain: " + assumed));
    else if (report->used)
        messages.push_back(EstimateText(e, given.camera_from) + "; the estimate is used");
}

// Gives the source as the run will read it, without the errors of its depth.
Status TakeCorrected(const RunRequest& request, const RunConfig& config, KeptSource& kept,
                     CheckedSource& checked) {
    Result<FrameSource*> source = kept.With(config);
    if (!source.ok()) return source.status();
    std::optional<DepthDistortionEstimate>& depth = checked.found.depth_distortion;
    depth = LookAtDepth(*source.value(), request.selection);
    source = kept.With(config);
    if (!source.ok()) return source.status();
    checked.source = kept.Take();
    if (!depth || !depth->shown()) return Status::Ok();
    depth->used = true;
    checked.source = CorrectDepth(std::move(checked.source), depth->found);
    checked.messages.push_back(DepthDistortionText(*depth) + ": corrected");
    return Status::Ok();
}

// Looks again with the first estimate if that differs from the given camera.
Result<std::optional<PinholeCamera>> FindCamera(const RunRequest& request, const RunConfig& config,
                                                const SourceInfo& given, KeptSource& kept,
                                                const std::optional<CameraEstimate>& first,
                                                std::optional<CameraReport>& report) {
    const auto to_use = [&](const CameraEstimate& estimate) -> std::optional<PinholeCamera> {
        const bool used = given.camera_known ? estimate.shown() : estimate.useful();
        report = CameraReport{estimate, given.camera_known, used};
        return used ? std::optional(CameraToUse(estimate, given.camera_known)) : std::nullopt;
    };
    if (!first) return std::optional<PinholeCamera>();
    std::optional<PinholeCamera> camera = to_use(*first);
    if (!camera) return camera;
    const Result<FrameSource*> again = kept.With(WithCamera(config, camera));
    if (!again.ok()) return again.status();
    std::optional<CameraEstimate> second =
        LookAtFirstSeconds(*again.value(), request.selection, true,
                           config.pipeline.shutter.colour_readout_s)
            .camera;
    if (!second) return camera;
    second->given = given.camera;
    second->misfit_given = first->misfit_given;
    return to_use(*second);
}

// Corrects the time stamps of colour in `config` if the images show an error.
void CorrectDelay(const FirstSeconds& seen, RunConfig& config, CheckedSource& checked) {
    checked.found.colour_delay = seen.delay;
    if (!checked.found.colour_delay || !checked.found.colour_delay->shown()) return;
    checked.found.colour_delay->used = true;
    config.source.colour_delay_s += checked.found.colour_delay->certain_s();
    checked.messages.push_back(
        fmt::format("{}: corrected by {:.1f} ms", ColourDelayText(*checked.found.colour_delay),
                    1000 * std::abs(checked.found.colour_delay->certain_s())));
}

// Corrects the registration and the brightness of colour in `config` if the images show errors, and
// looks again if they are large.
Status CorrectColour(const RunRequest& request, const SourceInfo& given, RunConfig& config,
                     KeptSource& kept, FirstSeconds& seen, CheckedSource& checked) {
    checked.found.colour_shift = seen.colour;
    if (seen.camera)
        checked.found.vignetting =
            VignettingReport{seen.camera->vignetting, seen.camera->vignetting_sigma};
    if (IsOni(request.source)) return Status::Ok();
    if (checked.found.colour_shift && checked.found.colour_shift->shown()) {
        checked.found.colour_shift->used = true;
        config.source.colour_shift_px = {checked.found.colour_shift->x_px,
                                         checked.found.colour_shift->y_px};
        checked.messages.push_back(ColourShiftText(*checked.found.colour_shift) + ": corrected");
    }
    if (seen.camera && seen.camera->believed(given.camera_known) &&
        seen.camera->vignetting_shown()) {
        VignettingReport& v = *checked.found.vignetting;
        v.used = true;
        config.source.vignetting = v.share;
        checked.messages.push_back(fmt::format(
            "the image's corners are {:.1f} +- {:.1f} % {} than its middle: corrected",
            100 * std::abs(v.share), 100 * v.sigma, v.share > 0 ? "darker" : "brighter"));
    }
    const bool moved = checked.found.colour_shift && checked.found.colour_shift->used;
    if (!moved && std::abs(config.source.vignetting) < kLookAgain) return Status::Ok();
    const Result<FrameSource*> again = kept.With(config);
    if (!again.ok()) return again.status();
    seen = LookAtFirstSeconds(*again.value(), request.selection, given.one_camera,
                              config.pipeline.shutter.colour_readout_s);
    if (config.source.vignetting != 0 && seen.camera && seen.camera->plausible())
        config.source.vignetting = checked.found.vignetting->share += seen.camera->vignetting;
    return Status::Ok();
}

}  // namespace

Result<CheckedSource> OpenCheckedSource(const RunRequest& request, const RunConfig& config,
                                        const std::atomic<bool>* stop) {
    CheckedSource checked;
    KeptSource kept(
        [&](const RunConfig& settings) { return OpenSource(request.source, settings, stop); });
    const Result<FrameSource*> opened = kept.With(config);
    if (!opened.ok()) return opened.status();
    const SourceInfo given = opened.value()->info();
    if (!config.check_camera || given.live || !IsFileOrFolder(request.source)) {
        checked.source = kept.Take();
        return checked;
    }
    RunConfig corrected = config;
    FirstSeconds seen = LookAtFirstSeconds(*opened.value(), request.selection, given.one_camera,
                                           config.pipeline.shutter.colour_readout_s);
    if (!IsOni(request.source))
        LookWithoutVignetting(*opened.value(), request.selection, kLookAgain,
                              config.pipeline.shutter.colour_readout_s, seen);
    if (Status status = CorrectColour(request, given, corrected, kept, seen, checked); !status.ok())
        return status;
    if (!IsOni(request.source)) CorrectDelay(seen, corrected, checked);
    std::optional<PinholeCamera> camera;
    if (request.resume || request.localise_only) {
        camera = CameraOfScan(request.scan_file, given.camera);
        if (camera)
            checked.messages.push_back(
                fmt::format("{} says fx {:.1f}, but the scan was made with {:.1f}, which is used",
                            given.camera_from, given.camera.fx, camera->fx));
    } else if (given.one_camera) {
        Result<std::optional<PinholeCamera>> found =
            FindCamera(request, corrected, given, kept, seen.camera, checked.found.camera);
        if (!found.ok()) return found.status();
        camera = found.value();
        Describe(given, checked.found.camera, checked.messages);
    }
    if (Status status = TakeCorrected(request, WithCamera(corrected, camera), kept, checked);
        !status.ok())
        return status;
    return checked;
}

}  // namespace tessera
