#pragma once
// A value or the sentence that says why there is none. Every fallible call of the project returns one.
#include <fmt/core.h>

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

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
  ErrorCode code;
  std::string message;
};

/// An error with a formatted message: `return fail(ErrorCode::io, "{} is empty.", path);`.
template <class... T>
Error fail(ErrorCode code, fmt::format_string<T...> message, T&&... arguments) {
  return {code, fmt::format(message, std::forward<T>(arguments)...)};
}

/// Either a T or an Error. To pass an error on: ASPIC_TRY, ASPIC_CHECK.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// The value; legal only if ok().
  T& value() & { return *value_if(); }
  const T& value() const& { return *const_cast<Result*>(this)->value_if(); }
  T&& value() && { return std::move(*value_if()); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return value_if(); }
  const T* operator->() const { return &value(); }

  /// The error; legal only if not ok().
  const Error& error() const {
    assert(!ok());
    return *std::get_if<Error>(&content_);
  }

 private:
  T* value_if() {
    assert(ok());
    return std::get_if<T>(&content_);
  }
  std::variant<T, Error> content_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const {
    assert(error_.has_value());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

}  // namespace aspic

#define ASPIC_JOIN_(a, b) a##b
#define ASPIC_JOIN(a, b) ASPIC_JOIN_(a, b)

/// Moves the value of a Result into `target`, which may declare a variable, or returns the error from the
/// enclosing function: `ASPIC_TRY(auto model, build_model(settings));`. Two statements: braces where one is
/// expected.
#define ASPIC_TRY(target, ...)                                                                  \
  auto ASPIC_JOIN(aspic_result_, __LINE__) = (__VA_ARGS__);                                     \
  if (!ASPIC_JOIN(aspic_result_, __LINE__)) return ASPIC_JOIN(aspic_result_, __LINE__).error(); \
  target = std::move(*ASPIC_JOIN(aspic_result_, __LINE__))

/// Returns the error of a Status from the enclosing function, if there is one.
#define ASPIC_CHECK(...)                                                                                \
  do {                                                                                                  \
    if (const ::aspic::Status aspic_status = (__VA_ARGS__); !aspic_status) return aspic_status.error(); \
  } while (false)
