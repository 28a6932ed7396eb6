// What the keys of the window do.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "viz/viewer_state.h"

namespace tessera {

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

}  // namespace tessera
