// Lifetime of the OpenNI2 library in this process, and its device events.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "io/openni_devices.h"

namespace tessera {

// Initialised by the first Acquire, shut down with its last owner. Thread-safe.
//
// The library (2.2) remembers every thread that ever called it, including its own recorder threads.
// When a new thread calls it, the library reads the memory of threads that have ended. That memory
// is usually still mapped. Even so, a process should call the library from few long-lived threads
// and should not start a second recording. Test programs run only one such test per process.
class OpenniRuntime {
  public:
    // The error says what the library could not find.
    static Result<std::shared_ptr<OpenniRuntime>> Acquire();
    ~OpenniRuntime();
    OpenniRuntime(const OpenniRuntime&) = delete;
    OpenniRuntime& operator=(const OpenniRuntime&) = delete;

    std::vector<OpenniDevice> Devices() const;

    // Device events since Watch(uri): the device was unplugged, or the recording reached its end.
    void Watch(const std::string& uri);
    bool WasUnplugged(const std::string& uri) const;
    bool ReachedEnd(const std::string& uri) const;

    // Returns when a device is plugged in or unplugged, or after `seconds`.
    void WaitForChange(double seconds);

  private:
    OpenniRuntime();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// The library's last error message, on one line.
std::string OpenniErrorText();

}  // namespace tessera
