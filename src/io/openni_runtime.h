// The OpenNI2 library's life in this process, and what it says about devices that come and go.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "io/openni_devices.h"

namespace tessera {

// Initialised with the first Acquire, shut down with its last owner. Thread-safe.
//
// The library (2.2) remembers every thread that ever called it, its own recorders' too, and looks
// at the dead ones' memory when another thread calls it first. That memory is mostly still there;
// but a process should call it from few threads that live long, and begin no second recording. Even
// a test program runs one such test per process.
class OpenniRuntime {
  public:
    // An error says what the library found missing.
    static Result<std::shared_ptr<OpenniRuntime>> Acquire();
    ~OpenniRuntime();
    OpenniRuntime(const OpenniRuntime&) = delete;
    OpenniRuntime& operator=(const OpenniRuntime&) = delete;

    std::vector<OpenniDevice> Devices() const;

    // Whether the device was unplugged, or the recording came to its end, since Watch(uri).
    void Watch(const std::string& uri);
    bool WasUnplugged(const std::string& uri) const;
    bool CameToItsEnd(const std::string& uri) const;

    // Returns when a device is plugged in or out, or after so long.
    void WaitForChange(double seconds);

  private:
    OpenniRuntime();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// What the library said last, on one line.
std::string OpenniErrorText();

}  // namespace tessera
