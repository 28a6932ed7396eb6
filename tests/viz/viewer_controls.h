// The fixture of the tests that click every control with real pointer events.
#pragma once

#include "viz/window_fixture.h"

namespace tessera {

class ViewerControls : public testing_support::WindowTest {};

}  // namespace tessera
