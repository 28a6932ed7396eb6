#include "viz/viewer_state.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
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
    if (method == settings.method) return;
    settings.method = method;
    SendSettings();
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

// A question is answered by its own keys; all others do nothing.
void ViewerState::Answer(int key) {
    const bool yes = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER || key == GLFW_KEY_Y;
    if (yes) Reset();
    if (yes || key == GLFW_KEY_ESCAPE || key == GLFW_KEY_N) ask_reset = false;
}

bool ViewerState::OnReplayKey(int key, int mods) {
    const int frames = mods & GLFW_MOD_SHIFT ? 10 : 1;
    switch (key) {
        case GLFW_KEY_SPACE: replay->TogglePlaying(); return true;
        case GLFW_KEY_LEFT: replay->Step(-frames); return true;
        case GLFW_KEY_RIGHT: replay->Step(frames); return true;
        case GLFW_KEY_HOME: replay->GoTo(0); return true;
        case GLFW_KEY_END: replay->GoTo(replay->last()); return true;
        default: return false;
    }
}

bool ViewerState::OnMeasuringKey(int key) {
    switch (key) {
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER: measuring.Finish(); return true;
        case GLFW_KEY_BACKSPACE: measuring.TakeBack(); return true;
        case GLFW_KEY_ESCAPE: measuring.Toggle(); return true;
        default: return false;
    }
}

void ViewerState::OnKey(int key, int mods) {
    if (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) return;
    if (asks()) return Answer(key);
    if (replay && OnReplayKey(key, mods)) return;
    if (measuring.on() && !show_help && OnMeasuringKey(key)) return;
    const auto method = static_cast<std::size_t>(key - GLFW_KEY_1);
    if (key >= GLFW_KEY_1 && method < kTrackingMethods.size())
        return SelectMethod(kTrackingMethods[method].method);
    switch (key) {
        case GLFW_KEY_SPACE: return TogglePause();
        case GLFW_KEY_S: return Step();
        case GLFW_KEY_R: ask_reset = !ended(); return;
        case GLFW_KEY_M: return SaveMesh();
        case GLFW_KEY_K: return SaveScan();
        case GLFW_KEY_V: return ToggleRecording();
        case GLFW_KEY_P: want_screenshot = true; return;
        case GLFW_KEY_TAB: return SwitchView();
        case GLFW_KEY_F: return ToggleFollow();
        case GLFW_KEY_E: return ToggleFirstPerson();
        case GLFW_KEY_L: return ToggleMeasuring();
        case GLFW_KEY_X: return ToggleCut();
        case GLFW_KEY_G: return finishing.Start();
        case GLFW_KEY_I: view.camera_image = !view.camera_image; return;
        case GLFW_KEY_A: return ViewAll();
        case GLFW_KEY_C: return CycleShading();
        case GLFW_KEY_W: view.wireframe = !view.wireframe; return;
        case GLFW_KEY_D: view.depth_test = !view.depth_test; return;
        case GLFW_KEY_B: view.show_objects = !view.show_objects; return;
        case GLFW_KEY_T: view.show_truth = !view.show_truth; return;
        case GLFW_KEY_H:
        case GLFW_KEY_F1: show_help = !show_help; return;
        case GLFW_KEY_ESCAPE:
            if (!show_help) close = true;
            show_help = false;
            return;
        case GLFW_KEY_Q: close = true; return;
        default: return;
    }
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
