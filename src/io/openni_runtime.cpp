#include "io/openni_runtime.h"

#include <OpenNI.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>

namespace tessera {
namespace {

// Held while the library starts or shuts down.
std::mutex& LifeMutex() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

std::string OpenniErrorText() {
    std::string text = openni::OpenNI::getExtendedError();
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text.empty() ? "no reason given" : text;
}

// The library calls these listeners from its driver threads.
struct OpenniRuntime::Impl : openni::OpenNI::DeviceConnectedListener,
                             openni::OpenNI::DeviceDisconnectedListener,
                             openni::OpenNI::DeviceStateChangedListener {
    void onDeviceConnected(const openni::DeviceInfo*) override {
        Change([] {});
    }
    void onDeviceDisconnected(const openni::DeviceInfo* info) override {
        Change([&] { unplugged.insert(info->getUri()); });
    }
    void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override {
        if (state == openni::DEVICE_STATE_EOF) Change([&] { ended.insert(info->getUri()); });
    }
    template <class Action>
    void Change(Action action) {
        const std::lock_guard lock(mutex);
        action();
        ++changes;
        changed.notify_all();
    }

    std::mutex mutex;  // protects everything below
    std::condition_variable changed;
    std::uint64_t changes = 0;
    std::set<std::string> unplugged, ended;
};

OpenniRuntime::OpenniRuntime() : impl_(std::make_unique<Impl>()) {
    openni::OpenNI::addDeviceConnectedListener(impl_.get());
    openni::OpenNI::addDeviceDisconnectedListener(impl_.get());
    openni::OpenNI::addDeviceStateChangedListener(impl_.get());
}

OpenniRuntime::~OpenniRuntime() {
    const std::lock_guard lock(LifeMutex());
    openni::OpenNI::removeDeviceConnectedListener(impl_.get());
    openni::OpenNI::removeDeviceDisconnectedListener(impl_.get());
    openni::OpenNI::removeDeviceStateChangedListener(impl_.get());
    openni::OpenNI::shutdown();
}

Result<std::shared_ptr<OpenniRuntime>> OpenniRuntime::Acquire() {
    static std::weak_ptr<OpenniRuntime> shared;
    const std::lock_guard lock(LifeMutex());
    if (auto runtime = shared.lock()) return runtime;
    if (openni::OpenNI::initialize() != openni::STATUS_OK) {
        const std::string why = OpenniErrorText();
        openni::OpenNI::shutdown();
        return Status::Error("OpenNI2 cannot be started: " + why + "; see tessera doctor");
    }
    std::shared_ptr<OpenniRuntime> runtime(new OpenniRuntime);
    shared = runtime;
    return runtime;
}

std::vector<OpenniDevice> OpenniRuntime::Devices() const {
    openni::Array<openni::DeviceInfo> infos;
    openni::OpenNI::enumerateDevices(&infos);
    std::vector<OpenniDevice> devices;
    for (int i = 0; i < infos.getSize(); ++i)
        devices.push_back({infos[i].getUri(), infos[i].getName(), infos[i].getVendor()});
    return devices;
}

void OpenniRuntime::Watch(const std::string& uri) {
    const std::lock_guard lock(impl_->mutex);
    impl_->unplugged.erase(uri);
    impl_->ended.erase(uri);
}

bool OpenniRuntime::WasUnplugged(const std::string& uri) const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->unplugged.contains(uri);
}

bool OpenniRuntime::ReachedEnd(const std::string& uri) const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->ended.contains(uri);
}

void OpenniRuntime::WaitForChange(double seconds) {
    std::unique_lock lock(impl_->mutex);
    impl_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                            [&, before = impl_->changes] { return impl_->changes != before; });
}

}  // namespace tessera
