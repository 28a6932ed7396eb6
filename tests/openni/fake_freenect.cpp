#include "openni/fake_freenect.h"

#include <libfreenect.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <thread>

struct _freenect_device {
    freenect_context* context = nullptr;
    std::string serial;
    void* user = nullptr;
    freenect_depth_cb on_depth = nullptr;
    freenect_video_cb on_colour = nullptr;
    bool depth_runs = false, colour_runs = false;
    int number = 0;
};

struct _freenect_context {
    std::set<freenect_device*> open;
};

namespace tessera::fake_freenect {
namespace {

constexpr int kWidth = 640, kHeight = 480;

struct World {
    std::mutex mutex;
    std::set<std::string> plugged, occupied;
    std::vector<std::string> calls;
    int open = 0;
};

World& TheWorld() {
    static World world;
    return world;
}

void Called(const std::string& call) {
    const std::lock_guard lock(TheWorld().mutex);
    TheWorld().calls.push_back(call);
}

bool IsPlugged(const std::string& serial) {
    const std::lock_guard lock(TheWorld().mutex);
    return TheWorld().plugged.contains(serial);
}

void ShowImages(freenect_device* device) {
    std::vector<std::uint16_t> depth;
    std::vector<std::uint8_t> colour;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            depth.push_back(PatternDepth_mm(device->number, x, y));
            for (int c = 0; c < 3; ++c) colour.push_back(PatternColour(device->number, x, y, c));
        }
    if (device->depth_runs) device->on_depth(device, depth.data(), 0);
    if (device->colour_runs) device->on_colour(device, colour.data(), 0);
    ++device->number;
}

}  // namespace

void Plug(const std::string& serial) {
    const std::lock_guard lock(TheWorld().mutex);
    TheWorld().plugged.insert(serial);
}

void Unplug(const std::string& serial) {
    const std::lock_guard lock(TheWorld().mutex);
    TheWorld().plugged.erase(serial);
}

void Occupy(const std::string& serial) {
    const std::lock_guard lock(TheWorld().mutex);
    TheWorld().occupied.insert(serial);
}

int OpenCameras() {
    const std::lock_guard lock(TheWorld().mutex);
    return TheWorld().open;
}

std::vector<std::string> Calls() {
    const std::lock_guard lock(TheWorld().mutex);
    return TheWorld().calls;
}

}  // namespace tessera::fake_freenect

using namespace tessera::fake_freenect;  // NOLINT: the functions below have libfreenect's names

extern "C" {

int freenect_init(freenect_context** context, freenect_usb_context*) {
    *context = new freenect_context;
    return 0;
}
int freenect_shutdown(freenect_context* context) {
    delete context;
    Called("shutdown");
    return 0;
}
void freenect_set_log_callback(freenect_context*, freenect_log_cb) {}
void freenect_select_subdevices(freenect_context*, freenect_device_flags) {}

int freenect_process_events_timeout(freenect_context* context, timeval*) {
    std::this_thread::sleep_for(std::chrono::milliseconds(33));  // the cameras' rate
    for (freenect_device* device : context->open) {
        if (!IsPlugged(device->serial)) return -1;
        ShowImages(device);
    }
    return 0;
}

int freenect_num_devices(freenect_context*) {
    const std::lock_guard lock(TheWorld().mutex);
    return static_cast<int>(TheWorld().plugged.size());
}
int freenect_list_device_attributes(freenect_context*, freenect_device_attributes** list) {
    const std::lock_guard lock(TheWorld().mutex);
    *list = nullptr;
    for (const std::string& serial : TheWorld().plugged) {
        *list = new freenect_device_attributes{*list, strdup(serial.c_str())};
    }
    return static_cast<int>(TheWorld().plugged.size());
}
void freenect_free_device_attributes(freenect_device_attributes* list) {
    while (list != nullptr) {
        freenect_device_attributes* const next = list->next;
        free(const_cast<char*>(list->camera_serial));
        delete list;
        list = next;
    }
}

int freenect_open_device_by_camera_serial(freenect_context* context, freenect_device** device,
                                          const char* serial) {
    const std::lock_guard lock(TheWorld().mutex);
    if (!TheWorld().plugged.contains(serial) || TheWorld().occupied.contains(serial)) return -1;
    *device = new freenect_device;
    (*device)->context = context;
    (*device)->serial = serial;
    context->open.insert(*device);
    ++TheWorld().open;
    TheWorld().calls.push_back("open " + (*device)->serial);
    return 0;
}
int freenect_close_device(freenect_device* device) {
    Called("close " + device->serial);
    {
        const std::lock_guard lock(TheWorld().mutex);
        --TheWorld().open;
    }
    device->context->open.erase(device);
    delete device;
    return 0;
}
void freenect_set_user(freenect_device* device, void* user) { device->user = user; }
void* freenect_get_user(freenect_device* device) { return device->user; }
void freenect_set_depth_callback(freenect_device* device, freenect_depth_cb callback) {
    device->on_depth = callback;
}
void freenect_set_video_callback(freenect_device* device, freenect_video_cb callback) {
    device->on_colour = callback;
}

freenect_frame_mode freenect_find_depth_mode(freenect_resolution, freenect_depth_format format) {
    freenect_frame_mode mode{};
    mode.depth_format = format;
    return mode;
}
freenect_frame_mode freenect_find_video_mode(freenect_resolution, freenect_video_format format) {
    freenect_frame_mode mode{};
    mode.video_format = format;
    return mode;
}
int freenect_set_depth_mode(freenect_device*, const freenect_frame_mode mode) {
    Called(mode.depth_format == FREENECT_DEPTH_REGISTERED ? "depth registered"
           : mode.depth_format == FREENECT_DEPTH_MM       ? "depth mm"
                                                          : "depth of another format");
    return 0;
}
int freenect_set_video_mode(freenect_device*, freenect_frame_mode mode) {
    Called(mode.video_format == FREENECT_VIDEO_RGB ? "colour" : "colour of another format");
    return 0;
}
int freenect_start_depth(freenect_device* device) {
    device->depth_runs = true;
    return 0;
}
int freenect_start_video(freenect_device* device) {
    device->colour_runs = true;
    return 0;
}
int freenect_stop_depth(freenect_device* device) {
    device->depth_runs = false;
    Called("stop depth");
    return 0;
}
int freenect_stop_video(freenect_device* device) {
    device->colour_runs = false;
    Called("stop colour");
    return 0;
}
int freenect_set_flag(freenect_device*, freenect_flag flag, freenect_flag_value value) {
    Called("flag " + std::to_string(flag) + " " + std::to_string(value));
    return 0;
}

}  // extern "C"
