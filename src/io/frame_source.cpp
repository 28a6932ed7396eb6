#include "io/frame_source.h"
