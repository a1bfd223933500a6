#pragma once
// Reads states into memory that is used again, and in parts.
#include <cstddef>
#include <type_traits>
#include <variant>

#include "aspic/solver.h"
#include "aspic/state.h"
#include "aspic/state_view.h"
#include "base/result.h"

namespace aspic {

/// Solver::state() into a State that is used again: one of the model's size keeps its memory. After an error
/// it holds no state. Errors: those of Solver::state().
Status read_state(Solver& solver, State& into);

/// `count` of the vectors from number `first` on; none of none.
template <class AnyVectors>
AnyVectors part_of(const AnyVectors& vectors, std::size_t first, std::size_t count) {
  return std::visit(
      [&](auto of) -> AnyVectors {
        if constexpr (!std::is_same_v<decltype(of), std::monostate>) {
          of.data += static_cast<std::ptrdiff_t>(first) * of.stride;
          of.count = count;
        }
        return of;
      },
      vectors);
}

}  // namespace aspic
