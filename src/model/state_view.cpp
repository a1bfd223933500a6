#include "aspic/state_view.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "base/result.h"
#include "model/counts.h"

namespace aspic {
namespace {

/// A conversion to a float out of its range is undefined, so larger numbers are infinite by decree.
template <class To, class From>
To converted(From x) {
  if constexpr (sizeof(To) < sizeof(From)) {
    constexpr From limit = std::numeric_limits<To>::max();
    if (std::abs(x) > limit) return static_cast<To>(std::copysign(HUGE_VAL, x));
  }
  return static_cast<To>(x);
}

template <class From, class To>
void copy_numbers(const From* from, To* to, std::size_t count) {
  if constexpr (std::is_same_v<From, To>)
    std::memcpy(to, from, count * sizeof(To));
  else
    for (std::size_t n = 0; n < count; ++n) to[n] = converted<To>(from[n]);
}

template <class From, class To>
void copy_strided(const Strided<const From>& from, const Strided<To>& to) {
  const auto whole = [](const auto& of) { return of.stride == 3 && of.component == 1; };
  if (from.count == 0) return;
  if (whole(from) && whole(to)) return copy_numbers(from.data, to.data, 3 * from.count);
  if (from.stride == 1 && to.stride == 1) {
    for (std::size_t c = 0; c < 3; ++c) copy_numbers(&from.at(0, c), &to.at(0, c), from.count);
    return;
  }
  if (from.stride == 1 && whole(to)) {  // the form that compilers make shuffles of
    const From *const x = &from.at(0, 0), *const y = &from.at(0, 1), *const z = &from.at(0, 2);
    To* const out = to.data;
    for (std::size_t i = 0; i < from.count; ++i) {
      out[3 * i] = converted<To>(x[i]);
      out[3 * i + 1] = converted<To>(y[i]);
      out[3 * i + 2] = converted<To>(z[i]);
    }
    return;
  }
  const From* f = from.data;
  To* t = to.data;
  if (from.component == 1 && to.component == 1) {
    for (std::size_t i = 0; i < from.count; ++i, f += from.stride, t += to.stride) {
      const From x = f[0], y = f[1], z = f[2];
      t[0] = converted<To>(x);
      t[1] = converted<To>(y);
      t[2] = converted<To>(z);
    }
    return;
  }
  for (std::size_t i = 0; i < from.count; ++i)
    for (std::size_t c = 0; c < 3; ++c) to.at(i, c) = converted<To>(from.at(i, c));
}

static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3>);

template <class View>
Status check_counts(const Model& model, const View& view, bool all) {
  for (std::size_t n = 0; n < view.size(); ++n) {
    const StateField& field = state_fields[n];
    const bool ball = field.carrier == StateCarrier::ball;
    const std::size_t wanted = ball ? model.ball_count() : model.particle_count();
    if (std::holds_alternative<std::monostate>(view[n]) ? !all || wanted == 0 : count_of(view[n]) == wanted)
      continue;
    return fail(ErrorCode::usage, "the view has {} vectors of {}, the scene has {} {}s", count_of(view[n]),
                field.name, wanted, ball ? "ball" : "particle");
  }
  return {};
}

}  // namespace

void copy_vectors(const ConstVectors& from, const Vectors& to) {
  std::visit(
      [](const auto& source, const auto& target) {
        using Source = std::decay_t<decltype(source)>;
        using Target = std::decay_t<decltype(target)>;
        if constexpr (!std::is_same_v<Source, std::monostate> && !std::is_same_v<Target, std::monostate>)
          copy_strided(source, target);
      },
      from, to);
}

Vectors vectors_of(std::vector<Vec3>& list) {
  return Strided<double>{list.empty() ? nullptr : &list.front().x, list.size()};
}
ConstVectors vectors_of(const std::vector<Vec3>& list) {
  return Strided<const double>{list.empty() ? nullptr : &list.front().x, list.size()};
}

StateView view_of(State& state) {
  StateView view;
  for (std::size_t n = 0; n < view.size(); ++n) view[n] = vectors_of(state.*state_fields[n].vectors);
  return view;
}
ConstStateView view_of(const State& state) {
  ConstStateView view;
  for (std::size_t n = 0; n < view.size(); ++n) view[n] = vectors_of(state.*state_fields[n].vectors);
  return view;
}

Status check_finite(const ConstStateView& view, Precision precision) {
  const double limit =
      precision == Precision::single ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
  for (std::size_t n = 0; n < view.size(); ++n) {
    const auto bad = std::visit(
        [&](const auto& of) -> std::optional<std::size_t> {
          if constexpr (!std::is_same_v<std::decay_t<decltype(of)>, std::monostate>) {
            for (std::size_t i = 0; i < of.count; ++i)
              for (std::size_t c = 0; c < StateField::components; ++c)
                if (!(std::abs(of.at(i, c)) <= limit)) return i;
          }
          return std::nullopt;
        },
        view[n]);
    if (!bad) continue;
    return fail(ErrorCode::usage, "the {} of {} {} is not a finite number in {} precision",
                state_fields[n].name, state_fields[n].carrier == StateCarrier::ball ? "ball" : "particle",
                *bad, name_of(precision));
  }
  return {};
}

Status check_sizes(const Model& model, const StateView& view) {
  return check_counts(model, view, false);
}
Status check_sizes(const Model& model, const ConstStateView& view, bool all) {
  return check_counts(model, view, all);
}

}  // namespace aspic
