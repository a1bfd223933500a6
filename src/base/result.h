#pragma once
// What makes an Error, and passes one on.
#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/error.h"

namespace aspic {

/// An error with a formatted message: `return fail(ErrorCode::io, "{} is empty.", path);`.
template <class... T>
Error fail(ErrorCode code, fmt::format_string<T...> message, T&&... arguments) {
  return {code, fmt::format(message, std::forward<T>(arguments)...)};
}

/// An error that another one led to: its code and remedies, in another sentence.
template <class... T>
Error fail(const Error& cause, fmt::format_string<T...> message, T&&... arguments) {
  return {cause.code, fmt::format(message, std::forward<T>(arguments)...), cause.remedies};
}

/// The error with remedies before those that it has:
/// `return advised(fail(…), {advice("make the scene smaller"), use_backend("cpu")});`.
inline Error advised(Error error, std::vector<Remedy> remedies) {
  error.remedies.insert(error.remedies.begin(), remedies.begin(), remedies.end());
  return error;
}

/// A remedy that everybody words alike: an imperative clause, without a capital and a full stop.
inline Remedy advice(std::string clause) {
  return {RemedyKind::words, {std::move(clause)}};
}

inline Remedy use_backend(std::string_view name) {
  return {RemedyKind::use_backend, {std::string(name)}};
}

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
