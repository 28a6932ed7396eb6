// An OpenNI2 driver without hardware. The runtime loads it instead of a camera's driver, for tests
// and for trying the program without a camera. Its devices show a known pattern (test_pattern.h) or
// a recorded folder.
//
// Use it with the program:
//     LD_LIBRARY_PATH=build/release/tests/openni/runtime TESSERA_TEST_DEVICE_FOLDER=/a/tum/folder
//     build/release/apps/tessera run openni2:
// runtime/ holds a copy of the OpenNI2 library, because the library looks for drivers only next to
// itself.
//
// Environment variables, read when the runtime is initialised. All begin with TESSERA_TEST_DEVICE_:
//   COUNT=1             number of devices at the start, with URIs test://0, test://1 ...
//   FOLDER=             TUM-layout folder to play forwards and backwards without end, at its
//                       recorded pace; empty: the pattern
//   PRELOAD=0           this many of its frames are decoded at the start, the others when shown
//   PACE=real           real: by the clock; fast: one frame whenever a client waits for one, so
//                       that nothing depends on timing
//   RATE=30             frames per second of the pattern
//   COLOUR_EVERY=1      only every n-th depth image comes with a colour image
//   COLOUR_DELAY_US=0   the colour stamps are this much later than the depth stamps
//   SMALL=0             1: 320x240 is the only mode
//   REGISTRATION=1      0: no depth-to-colour registration
//   SYNC=0              1: frame sync is supported
//   DROP=0              per cent of the images that are dropped
//   GARBAGE=0           per cent of the images that have a wrong size, are empty or noise, or have
//                       a stamp that goes back or is absurd
//   SEED=1              random seed of DROP and GARBAGE, which affect each image independently
//   STALL_AT=-1 STALL_MS=1500   before this frame no image comes for this long
//   VANISH_AT=-1 BACK_MS=-1     before this frame the device is unplugged; after this long it is
//                               plugged in again (-1: never) and its clock restarts
//   VANISH_EVERY=0      this happens again and again, every so many frames
//   LOG=                file to which settings made by the program are appended: "depth mirror 0"
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include "openni/test_device.h"

namespace tessera::test_device {

class TestDriver : public oni::driver::DriverBase {
  public:
    explicit TestDriver(OniDriverServices* services)
        : DriverBase(services), settings_(DeviceSettings::FromEnvironment()) {}

    OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                         oni::driver::DeviceDisconnectedCallback disconnected,
                         oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
        DriverBase::initialize(connected, disconnected, changed, cookie);
        for (int i = 0; i < settings_.devices; ++i) {
            const std::string uri = "test://" + std::to_string(i);
            Entry& entry = entries_[uri];
            entry.shared.settings = settings_;
            entry.shared.log = [this](const std::string& line) { Log(line); };
            entry.shared.feed = settings_.folder.empty()
                                    ? MakePatternFeed(settings_.rate_hz)
                                    : MakeFolderFeed(settings_.folder, settings_.preload);
            if (entry.shared.feed == nullptr) return ONI_STATUS_ERROR;
            std::strncpy(entry.info.uri, uri.c_str(), ONI_MAX_STR - 1);
            std::strncpy(entry.info.vendor, "Tessera", ONI_MAX_STR - 1);
            std::strncpy(entry.info.name, "Test camera", ONI_MAX_STR - 1);
            deviceConnected(&entry.info);
        }
        return ONI_STATUS_OK;
    }

    oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
        const auto found = entries_.find(uri);
        if (found == entries_.end()) return nullptr;
        Entry& entry = found->second;
        return new TestDevice(entry.shared, [this, &entry] { Vanish(entry); });
    }
    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
    void shutdown() override {
        if (timer_.joinable()) {
            timer_.request_stop();
            timer_.join();
        }
    }
    void* enableFrameSync(oni::driver::StreamBase**, int) override {
        return settings_.sync ? this : nullptr;
    }

  private:
    struct Entry {
        OniDeviceInfo info{};
        TestDevice::Shared shared;
    };

    void Vanish(Entry& entry) {
        deviceDisconnected(&entry.info);
        if (settings_.back_ms < 0) return;
        timer_ = std::jthread([this, &entry](const std::stop_token& stop) {
            std::mutex mutex;
            std::condition_variable_any wake;
            std::unique_lock lock(mutex);
            wake.wait_for(lock, stop, std::chrono::milliseconds(settings_.back_ms),
                          [] { return false; });
            if (!stop.stop_requested()) deviceConnected(&entry.info);
        });
    }

    void Log(const std::string& line) const {
        if (!settings_.log.empty()) std::ofstream(settings_.log, std::ios::app) << line << '\n';
    }

    const DeviceSettings settings_;
    std::map<std::string, Entry> entries_;
    std::jthread timer_;
};

}  // namespace tessera::test_device

// OpenNI2's macro uses allocation macros of a library that is not published with it.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(object) delete (object)
ONI_EXPORT_DRIVER(tessera::test_device::TestDriver)
