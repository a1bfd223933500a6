#pragma once
// The numbers of a state where they lie: in a solver's arrays, in a caller's.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "aspic/export.h"
#include "aspic/state.h"

namespace aspic {

/// Vectors of three numbers of type T: component c of vector i is data[i·stride + c·component], in numbers.
template <class T>
struct Strided {
  T* data = nullptr;                         ///< component 0 of vector 0
  std::size_t count = 0;                     ///< of vectors
  std::ptrdiff_t stride = 3, component = 1;  ///< in numbers, not bytes; of any sign

  T& at(std::size_t i, std::size_t c) const {  ///< component c of vector i; not checked
    return data[static_cast<std::ptrdiff_t>(i) * stride + static_cast<std::ptrdiff_t>(c) * component];
  }
};

/// Vectors of float or double; std::monostate: none.
using Vectors = std::variant<std::monostate, Strided<float>, Strided<double>>;
/// The same, to be read only.
using ConstVectors = std::variant<std::monostate, Strided<const float>, Strided<const double>>;

/// How many vectors.
template <class AnyVectors>
std::size_t count_of(const AnyVectors& vectors) {
  return std::visit(
      [](const auto& of) -> std::size_t {
        if constexpr (std::is_same_v<std::decay_t<decltype(of)>, std::monostate>)
          return 0;
        else
          return of.count;
      },
      vectors);
}

/// Copies vectors, as many as `from` has, and converts them where the types differ; nothing where either is
/// none. Doubles are rounded to floats; larger ones than a float holds become infinite.
ASPIC_API void copy_vectors(const ConstVectors& from, const Vectors& to);

/// A place for each field of state_fields, in its order. What is none is left out.
using StateView = std::array<Vectors, state_fields.size()>;
/// The same, to be read only.
using ConstStateView = std::array<ConstVectors, state_fields.size()>;

void no_field_of_that_name();  ///< defined nowhere: field_number() must not come to it

/// The number of a field in the table: field_number("velocity"). A name that is in no table does not compile.
consteval std::size_t field_number(std::string_view name) {
  for (std::size_t n = 0; n < state_fields.size(); ++n)
    if (state_fields[n].name == name) return n;
  no_field_of_that_name();  // is no constant expression
  return state_fields.size();
}

/// The vectors of a list.
ASPIC_API Vectors vectors_of(std::vector<Vec3>& list);
ASPIC_API ConstVectors vectors_of(const std::vector<Vec3>& list);
/// All fields of a state.
ASPIC_API StateView view_of(State& state);
ASPIC_API ConstStateView view_of(const State& state);

}  // namespace aspic
