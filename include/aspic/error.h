#pragma once
// A value or the sentence that says why there is none. Every fallible call returns one.
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "aspic/export.h"

namespace aspic {

/// Why a call failed. The values are the program's exit codes (docs: README, "Exit codes").
enum class ErrorCode {
  check_failed = 1,    ///< a comparison or verification failed
  usage = 2,           ///< the command line is wrong
  scene_rejected = 3,  ///< the scene is wrong, too large, or asks for what is not built yet
  no_device = 4,       ///< no usable GL device
  diverged = 5,        ///< the simulation left the range of sane numbers
  io = 6,              ///< a file could not be read or written
  interrupted = 130    ///< Ctrl-C
};

/// An error: its code, and one or more complete sentences that say where, what and how to fix it.
struct Error {
  ErrorCode code;       ///< also fit for a program to end with
  std::string message;  ///< UTF-8, of one or more lines
};

/// Ends the program with a sentence: a Result was asked for what it does not hold.
[[noreturn]] ASPIC_API void end_at_wrong_access(const Error* error) noexcept;

/// Either a T or an Error. A plain value: one thread changes it, or several read.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  bool ok() const { return content_.index() == 0; }  ///< whether there is a value
  explicit operator bool() const { return ok(); }

  /// The value. Only if ok(): otherwise the program ends with the error.
  T& value() & { return *value_if(); }
  const T& value() const& { return *const_cast<Result*>(this)->value_if(); }
  T&& value() && { return std::move(*value_if()); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return value_if(); }
  const T* operator->() const { return &value(); }

  /// The error. Only if not ok(): otherwise the program ends.
  const Error& error() const {
    if (ok()) end_at_wrong_access(nullptr);
    return *std::get_if<Error>(&content_);
  }

 private:
  T* value_if() {
    if (!ok()) end_at_wrong_access(std::get_if<Error>(&content_));
    return std::get_if<T>(&content_);
  }
  std::variant<T, Error> content_;
};

/// Success without a value, or an Error; threads as above.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  bool ok() const { return !error_.has_value(); }  ///< whether the call succeeded
  explicit operator bool() const { return ok(); }
  const Error& error() const {  ///< only if not ok(): otherwise the program ends
    if (!error_) end_at_wrong_access(nullptr);
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

/// What a call returns that gives no value.
using Status = Result<void>;

}  // namespace aspic
