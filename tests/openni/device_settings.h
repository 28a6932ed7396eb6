// Settings of the test driver's devices, read from the environment when the OpenNI2 runtime loads
// the driver. test_driver.cpp lists the variables.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace tessera::test_device {

struct DeviceSettings {
    int devices = 1;
    std::string folder;
    int preload = 0;
    bool fast = false;
    double rate_hz = 30;
    int colour_every = 1;
    int colour_delay_us = 0;
    bool small = false, registration = true, sync = false;
    int drop_percent = 0, garbage_percent = 0, seed = 1;
    int stall_at = -1, stall_ms = 1500;
    int vanish_at = -1, vanish_every = 0, back_ms = -1;
    std::string log;

    static DeviceSettings FromEnvironment() {
        const auto text = [](const char* name) {
            const char* value = std::getenv((std::string("TESSERA_TEST_DEVICE_") + name).c_str());
            return std::string(value == nullptr ? "" : value);
        };
        const auto number = [&](const char* name, int fallback) {
            return text(name).empty() ? fallback : std::atoi(text(name).c_str());
        };
        DeviceSettings s;
        s.devices = number("COUNT", s.devices);
        s.folder = text("FOLDER");
        s.preload = number("PRELOAD", s.preload);
        s.fast = text("PACE") == "fast";
        if (!text("RATE").empty()) s.rate_hz = std::atof(text("RATE").c_str());
        s.colour_every = number("COLOUR_EVERY", s.colour_every);
        s.colour_delay_us = number("COLOUR_DELAY_US", s.colour_delay_us);
        s.small = number("SMALL", 0) != 0;
        s.registration = number("REGISTRATION", 1) != 0;
        s.sync = number("SYNC", 0) != 0;
        s.drop_percent = number("DROP", 0);
        s.garbage_percent = number("GARBAGE", 0);
        s.seed = number("SEED", s.seed);
        s.stall_at = number("STALL_AT", s.stall_at);
        s.stall_ms = number("STALL_MS", s.stall_ms);
        s.vanish_at = number("VANISH_AT", s.vanish_at);
        s.vanish_every = number("VANISH_EVERY", s.vanish_every);
        s.back_ms = number("BACK_MS", s.back_ms);
        s.log = text("LOG");
        return s;
    }
};

// A fault injected into one image of one stream.
enum class Fault { kNone, kDropped, kWrongSize, kNoData, kNoise, kBackwards, kAbsurdStamp };

// 32 well-mixed bits (splitmix64) that depend only on a and b.
inline std::uint32_t Mixed(std::uint64_t a, std::uint64_t b) {
    std::uint64_t z = a * 0x9e3779b97f4a7c15ULL + b * 0xbf58476d1ce4e5b9ULL + 0x94d049bb133111ebULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 16);
}

inline Fault FaultOf(const DeviceSettings& s, int number, bool depth) {
    const std::uint32_t dice =
        Mixed(static_cast<std::uint64_t>(s.seed), static_cast<std::uint64_t>(2 * number + depth));
    const int percent = static_cast<int>(dice % 100);
    if (percent < s.drop_percent) return Fault::kDropped;
    if (percent >= s.drop_percent + s.garbage_percent) return Fault::kNone;
    return static_cast<Fault>(static_cast<int>(Fault::kWrongSize) +
                              static_cast<int>(dice / 100 % 5));
}

}  // namespace tessera::test_device
