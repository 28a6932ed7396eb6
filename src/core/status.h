// The outcome of an operation that user input can make fail: a file, a flag, a key. The message
// names the file or key, says what is wrong and what to do. Programs print it and exit with 2. A
// plain value, freely copyable.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/printable.h"

namespace tessera {

class [[nodiscard]] Status {
  public:
    Status() = default;  // success
    static Status Ok() { return {}; }
    static Status Error(const std::string& message) {
        Status status;
        status.failed_ = true;
        status.message_ = Printable(message);
        return status;
    }

    bool ok() const { return !failed_; }
    // The error text, safe to print whatever a file put into it; empty on success.
    const std::string& message() const { return message_; }

  private:
    bool failed_ = false;
    std::string message_;
};

// The first that is an error; Ok if none is.
inline Status FirstError(std::initializer_list<Status> statuses) {
    for (const Status& status : statuses)
        if (!status.ok()) return status;
    return Status::Ok();
}

// A value of type T, or the error that prevented it.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : value_(std::move(value)) {}       // NOLINT: implicit by design
    Result(Status error) : status_(std::move(error)) {  // NOLINT
        TESSERA_CHECK(!status_.ok(), "a Result without value needs an error");
    }

    bool ok() const { return value_.has_value(); }
    const Status& status() const { return status_; }
    const std::string& message() const { return status_.message(); }
    T& value() {
        TESSERA_CHECK(ok(), "{}", message());
        return *value_;
    }
    const T& value() const {
        TESSERA_CHECK(ok(), "{}", message());
        return *value_;
    }

  private:
    std::optional<T> value_;
    Status status_;
};

}  // namespace tessera
