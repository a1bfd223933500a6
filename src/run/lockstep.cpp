#include "run/lockstep.h"

#include <algorithm>
#include <cstring>

#include "model/reading.h"

namespace aspic {
namespace {

bool same_bits(const State& a, const State& b) {
  return std::ranges::all_of(state_fields, [&](const StateField& field) {
    const auto &x = a.*field.vectors, &y = b.*field.vectors;
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(Vec3)) == 0);
  });
}

Error one_state(const Solver& first, const Solver& second) {
  return fail(ErrorCode::check_failed,
              "a step of one solver ({}) changed the state of the other ({}): they share a state, so nothing "
              "was compared. Report this fault of Aspic or of the driver.",
              first.description(), second.description());
}

}  // namespace

void WorstDifference::take(const QuantityDifference& d, std::uint64_t step) {
  if (d.absolute > absolute) {
    absolute = d.absolute;
    absolute_index = d.absolute_index;
    absolute_step = step;
  }
  if (d.ulp > ulp) {
    ulp = d.ulp;
    ulp_index = d.ulp_index;
    ulp_step = step;
  }
}

double LockstepResult::largest_absolute() const {
  return std::ranges::max_element(worst, {}, &WorstDifference::absolute)->absolute;
}

Result<LockstepResult> compare_in_lockstep(Solver& first, Solver& second, std::uint64_t steps,
                                           const std::function<bool(std::uint64_t)>& go_on,
                                           const InputLog& inputs) {
  LockstepResult result;
  if (&first == &second) return one_state(first, second);
  bool apart = false;
  State a, b;
  const auto ended = [&] {
    result.hash = {state_hash_text(a), state_hash_text(b)};
    return std::move(result);
  };
  for (std::uint64_t step = 0;; ++step) {
    ASPIC_CHECK(read_state(first, a));
    ASPIC_CHECK(read_state(second, b));
    ASPIC_TRY(const auto difference, compare_states(a, b));
    // States of two precisions with equal single-precision values still differ where a number does.
    if (!result.first_difference && (!difference.identical() || difference.largest_absolute() > 0.0))
      result.first_difference = step;
    for (std::size_t i = 0; i < result.worst.size(); ++i)
      result.worst[i].take(difference.*compared_quantities[i], step);
    result.steps = step;
    result.interrupted = !go_on(step);
    if (step == steps || result.interrupted) return ended();

    for (Solver* const solver : {&first, &second}) ASPIC_CHECK(solver->set_inputs(inputs.at(a.step)));
    ASPIC_TRY(const Advance one, first.advance(1));
    result.divergence[0] = one.divergence;
    if (!apart) {
      ASPIC_TRY(const auto stepped, first.state());
      ASPIC_TRY(const auto untouched, second.state());
      if (!same_bits(untouched, b)) return one_state(first, second);
      apart = !same_bits(stepped, a);
    }
    ASPIC_TRY(const Advance other, second.advance(1));
    result.divergence[1] = other.divergence;
    if (result.divergence[0] || result.divergence[1]) return ended();
  }
}

}  // namespace aspic
