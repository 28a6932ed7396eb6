#include "viz/viewer_state.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>

namespace tessera {

const char* ToString(Shading shading) {
    switch (shading) {
        case Shading::kColour: return "Colour";
        case Shading::kLabel: return "Label";
        case Shading::kWeight: return "Weight";
        case Shading::kGrey: return "Grey";
        case Shading::kNormal: return "Normal";
        case Shading::kCoverage: return "Coverage";
    }
    return "";
}

void ViewerState::Send(ViewerCommand::Kind kind, const std::string& path) {
    link->commands.Push({kind, path});
}

void ViewerState::SendSettings() {
    if (!ended()) link->settings.Push(ViewerSettings(settings));
}

void ViewerState::SelectMethod(TrackingMethod method) {
    if (ended() || method == this->method()) return;
    settings.method = method;
    ++settings.method_choices;
    SendSettings();
}

TrackingMethod ViewerState::method() const {
    const FrameReport& newest = system.frame().report;
    const bool heeded = system.has_frame() && newest.method_choices == settings.method_choices;
    return heeded ? newest.method : settings.method;
}

void ViewerState::RasteriseViews(bool on) {
    settings.prediction = on ? IcpTracker::Prediction::kRaster : IcpTracker::Prediction::kRayCast;
    settings.labels.prediction = on ? LabelPrediction::kRaster : LabelPrediction::kRayCast;
    SendSettings();
}

void ViewerState::UseClass(int id, bool on) {
    settings.labels.ignored[static_cast<std::size_t>(id)] = !on;
    SendSettings();
}

// Labelling that was off begins again.
void ViewerState::UseDetector(const std::string& name) {
    settings.detector = name;
    ++settings.detector_choice;
    settings.labels.on = true;
    SendSettings();
}

void ViewerState::TogglePause() {
    if (ended()) return;
    Send(paused() ? ViewerCommand::Kind::kResume : ViewerCommand::Kind::kPause);
}

void ViewerState::Step() {
    if (!ended()) Send(ViewerCommand::Kind::kStep);
}

void ViewerState::Reset() {
    if (!ended()) Send(ViewerCommand::Kind::kReset);
}

void ViewerState::SaveMesh() {
    if (can_save()) Send(ViewerCommand::Kind::kSaveMesh, NewFileName("mesh", "ply"));
}

void ViewerState::SaveScan() {
    if (can_save()) Send(ViewerCommand::Kind::kSaveScan, NewFileName("saved", "scan"));
}

void ViewerState::ToggleRecording() {
    if (ended()) return;
    if (recording())
        Send(ViewerCommand::Kind::kStopRecording);
    else
        Send(ViewerCommand::Kind::kRecord, NewFileName("recording", ""));
}

void ViewerState::CycleShading() {
    if (view_kind == ViewKind::kScan) {
        view.coverage = !view.coverage;
        return;
    }
    do view.shading = static_cast<Shading>((static_cast<int>(view.shading) + 1) % kShadings);
    while (!CanShade(view.shading));
}

bool ViewerState::CanShade(Shading shading) const {
    switch (shading) {
        case Shading::kLabel: return labelled();
        case Shading::kWeight:
        case Shading::kCoverage: return link != nullptr;
        default: return true;
    }
}

void ViewerState::ToggleFollow() {
    view.follow = !view.follow && (link || replay);
    view.keep_all = false;
}

void ViewerState::ToggleFirstPerson() {
    view.first_person = !view.first_person;
    if (view.first_person) view.keep_all = false;
}

void ViewerState::ViewAll() {
    view.follow = view.first_person = false;
    view.keep_all = true;
}

void ViewerState::SwitchView() {
    if (link) view_kind = view_kind == ViewKind::kScan ? ViewKind::kExpert : ViewKind::kScan;
}

// Measurements of earlier views are shown at once with a model, and after a run when asked for.
void ViewerState::ToggleMeasuring() {
    if (!can_measure()) return;
    ReadMeasurementsOnce();
    measuring.Toggle();
}

void ViewerState::ReadMeasurementsOnce() {
    if (!measurements_read_) measuring.Open(options.measurements);
    measurements_read_ = true;
}

bool ViewerState::UpdateNote() {
    const bool came = noted_ != system.messages_said(), stood = note_stands_;
    noted_ = system.messages_said();
    if (came) note_until_s_ = now_s + options.message_s;
    note_stands_ = now_s < note_until_s_;
    return came || note_stands_ != stood;
}

// The expert view of a run has a list instead.
const std::string* ViewerState::note() const {
    const bool listed = link && view_kind == ViewKind::kExpert;
    return note_stands_ && !listed ? &system.messages().back() : nullptr;
}

void ViewerState::ToggleCut() { view.cut = view.cut == Cut::kNone ? Cut::kAbove : Cut::kNone; }

Shading ViewerState::shading() const {
    if (view_kind == ViewKind::kExpert) return view.shading;
    return view.coverage ? Shading::kCoverage : Shading::kColour;
}

Quality ViewerState::quality() const {
    return QualityOf({.frame = system.has_frame() ? &system.frame() : nullptr,
                      .recent = system.recent().counts(),
                      .silent_s = system.recent().SilentFor_s(now_s),
                      .ended = ended(),
                      .paused = paused(),
                      .fusing = settings.fusing,
                      .detector_failed = system.labels().stopped});
}

std::string ViewerState::NewFileName(const char* prefix, const char* extension) const {
    namespace fs = std::filesystem;
    std::error_code ignored;  // the code that writes the file reports the error
    fs::create_directories(options.output_folder, ignored);
    const std::string ending = *extension ? std::string(".") + extension : "";
    const std::string stem =
        fmt::format("{}-{:%Y%m%d-%H%M%S}", prefix, fmt::localtime(std::time(nullptr)));
    fs::path path = fs::path(options.output_folder) / (stem + ending);
    for (int i = 2; fs::exists(path, ignored); ++i)
        path = fs::path(options.output_folder) / fmt::format("{}-{}{}", stem, i, ending);
    return path.string();
}

}  // namespace tessera
