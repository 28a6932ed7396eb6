#include "kinect/usb_thread.h"

#include <sys/time.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace tessera::kinect {
namespace {

constexpr int kWait_us = 20000;
constexpr auto kBetweenLooks = std::chrono::seconds(1);

std::set<std::string> Serials(freenect_context* context) {
    std::set<std::string> serials;
    freenect_device_attributes* list = nullptr;
    if (freenect_list_device_attributes(context, &list) <= 0) return serials;
    for (const freenect_device_attributes* at = list; at != nullptr; at = at->next)
        if (at->camera_serial != nullptr) serials.insert(at->camera_serial);
    freenect_free_device_attributes(list);
    return serials;
}

}  // namespace

UsbThread::~UsbThread() { Stop(); }

bool UsbThread::Start(Changed changed) {
    if (freenect_init(&context_, nullptr) < 0) return false;
    freenect_set_log_callback(context_, [](freenect_context*, freenect_loglevel, const char*) {});
    freenect_select_subdevices(context_, FREENECT_DEVICE_CAMERA);
    changed_ = std::move(changed);
    LookForChanges();
    thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
    return true;
}

void UsbThread::Stop() {
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
    }
    if (context_ != nullptr) freenect_shutdown(std::exchange(context_, nullptr));
}

void UsbThread::Later(freenect_device* device, std::function<void()> work) {
    const std::lock_guard lock(later_mutex_);
    later_.emplace_back(device, std::move(work));
}

void UsbThread::Close(freenect_device* device) {
    {
        const std::lock_guard lock(later_mutex_);
        std::erase_if(later_, [&](const auto& work) { return work.first == device; });
    }
    freenect_close_device(device);
}

void UsbThread::Run(const std::stop_token& stop) {
    auto next_look = std::chrono::steady_clock::now() + kBetweenLooks;
    while (!stop.stop_requested()) {
        bool healthy = true;
        Locked([&] {
            for (const auto& work : TakeLater()) work.second();
            timeval wait{0, kWait_us};
            healthy = freenect_process_events_timeout(context_, &wait) >= 0;
        });
        // A mutex is not fair: without this, others could wait for ever.
        while (waiting_ > 0) std::this_thread::yield();
        const auto now = std::chrono::steady_clock::now();
        if (healthy && now < next_look) continue;
        next_look = now + kBetweenLooks;
        // Counting does not disturb a camera that runs; reading its serial number may.
        const bool same = Locked([this] { return freenect_num_devices(context_) == count_; });
        if (!same) LookForChanges();
        // The error of a camera that was unplugged comes again and again until it is closed.
        if (!healthy) std::this_thread::sleep_for(std::chrono::microseconds(kWait_us));
    }
}

UsbThread::LateWork UsbThread::TakeLater() {
    const std::lock_guard lock(later_mutex_);
    return std::exchange(later_, {});
}

void UsbThread::LookForChanges() {
    const std::set<std::string> now = Locked([this] {
        count_ = freenect_num_devices(context_);
        return Serials(context_);
    });
    std::vector<std::string> came, went;
    std::ranges::set_difference(now, serials_, std::back_inserter(came));
    std::ranges::set_difference(serials_, now, std::back_inserter(went));
    serials_ = now;
    if (!came.empty() || !went.empty()) changed_(came, went);
}

}  // namespace tessera::kinect
