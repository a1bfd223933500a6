#pragma once
// A value or the sentence that says why there is none. Every fallible call returns one.
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "aspic/export.h"

namespace aspic {

/// Why a call failed. The values are the program's exit codes (docs: README, "Exit codes").
enum class ErrorCode {
  check_failed = 1,    ///< a comparison or verification failed
  usage = 2,           ///< an argument is wrong
  scene_rejected = 3,  ///< the scene is wrong or too large
  no_device = 4,       ///< no usable GL device
  diverged = 5,        ///< the simulation left the range of sane numbers
  io = 6,              ///< a file could not be read or written
  interrupted = 130    ///< Ctrl-C
};

/// What helps against an error, as far as callers differ in how they do it. worded() has the words.
enum class RemedyKind {
  words,           ///< `values[0]` is an imperative clause for everybody: "make the scene smaller"
  use_backend,     ///< compute on the backend `values[0]`, a word of parse_backend()
  draw_nothing,    ///< compute on the backend `values[0]` without images, which need a device
  overwrite,       ///< allow that what is there already is replaced
  lower_fps,       ///< at most `values[0]` images per second
  raise_speed,     ///< at least `values[0]` simulated seconds per second shown
  shorten,         ///< simulate less time
  image_size,      ///< images of `values[0]` × `values[1]` pixels
  write_images,    ///< numbered images in place of a video
  resume,          ///< continue the run of the checkpoint `values[0]`, a path
  replay,          ///< give the inputs of `values[0]`, a path, to a run
  give_checkpoint  ///< name a file that is a checkpoint
};

/// One thing that helps.
struct Remedy {
  RemedyKind kind = RemedyKind::words;   ///< what to do
  std::vector<std::string> values = {};  ///< as the kind says
  friend bool operator==(const Remedy&, const Remedy&) = default;
};

/// An error. A plain value.
struct Error {
  ErrorCode code;                     ///< also fit for a program to end with
  std::string what;                   ///< what is wrong, and where: UTF-8, of one or more lines
  std::vector<Remedy> remedies = {};  ///< any one helps; the best one first; none where `what` says it all
  ASPIC_API std::string message() const;  ///< both, as worded() for programs in C++
};

/// Who reads an error: each names a remedy as it is done there.
enum class FrontEnd { library, command_line, window, python };

/// What is wrong, then the remedies in a sentence. Those that the reader has no way to are left out.
ASPIC_API std::string worded(const Error& error, FrontEnd front_end);

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
