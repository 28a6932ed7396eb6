// What the start screen and the viewer need to know of the window they are in.
#pragma once

namespace tessera {

struct ScreenOptions {
    // Initial size of the window, in pixels of a standard-density display.
    int width = 1280, height = 720;
    double scale = 0;             // of text and sizes; 0: the display's
    double wait_s = 1.0 / 30;     // maximum sleep of RunOnce when there is nothing to do
    double double_click_s = 0.3;  // maximum time between the two clicks
};

}  // namespace tessera
