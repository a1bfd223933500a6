#pragma once
// What all bindings share: the library's errors as exceptions, vectors as arrays of numpy.
#include <aspic/error.h>
#include <aspic/parameters.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <exception>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "unlocked.h"

namespace aspic::python {

/// An error of the library on its way to Python, where it becomes a subclass of aspic.Error.
class LibraryError : public std::exception {
 public:
  explicit LibraryError(const Error& error) : code_(error.code), text_(worded(error, FrontEnd::python)) {}
  const char* what() const noexcept override { return text_.c_str(); }
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
  std::string text_;
};

/// The value of a result, or its error thrown.
template <class T>
T take(Result<T> result) {
  if (!result) throw LibraryError(result.error());
  return std::move(result).value();
}

inline void check(const Status& status) {
  if (!status) throw LibraryError(status.error());
}

/// Raised by a call that stop() of another thread ended.
inline LibraryError stopped_error() {
  return LibraryError({ErrorCode::interrupted, "stop() ended the call; the state is that of a whole step"});
}

/// Without the GIL. True: a signal's handler raised an exception, which is set; or the interpreter ends.
inline bool signalled() {
  if (Unlocked::ending()) return true;
  const nb::gil_scoped_acquire own;
  return PyErr_CheckSignals() != 0;
}

/// Has LibraryError raised as the exception of its code.
void register_errors();

/// An array of numpy that owns its numbers.
template <class T>
using Array = nb::ndarray<nb::numpy, T>;

/// One that takes over the numbers; `shape` has as many in all.
template <class T>
Array<T> as_array(std::vector<T> numbers, std::initializer_list<std::size_t> shape) {
  auto* const held = new std::vector<T>(std::move(numbers));
  const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Array<T>(held->data(), shape, owner);
}

/// A parameter's value: a number, a word, a tuple or a list.
nb::object as_object(const ParameterValue& value);

void bind_scene(nb::module_& module);
void bind_state(nb::module_& module);
void bind_simulation(nb::module_& module);
void bind_batch(nb::module_& module);
void bind_sweep(nb::module_& module);
void bind_export(nb::module_& module);

}  // namespace aspic::python
