#include "aspic/state_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "model/counts.h"
#include "support/model_building.h"
#include "support/random_state.h"

namespace aspic {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(StateFields, HaveNamesOfTheirOwnAndOneQuantityACarrier) {
  std::set<std::string_view> names;
  std::set<std::pair<StateCarrier, std::string_view>> symbols;
  for (const StateField& field : state_fields) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    EXPECT_TRUE(symbols.insert({field.carrier, field.symbol}).second) << field.name;
  }
  EXPECT_EQ(numbers_of(StateCarrier::particle), 6u);
  EXPECT_EQ(numbers_of(StateCarrier::ball), 9u);
  EXPECT_EQ(field_number("ball_velocity"), 3u);
}

TEST(StateFields, AreWalkedCarrierByCarrier) {
  State state;
  resize(state, 2, 1);
  state.position = {{1, 0, 0}, {3, 0, 0}};
  state.velocity = {{2, 0, 0}, {4, 0, 0}};
  state.ball_position = {{5, 0, 0}};
  state.ball_velocity = {{6, 0, 0}};
  state.ball_angular_velocity = {{7, 0, 0}};
  std::vector<double> met;
  for_each_vector(state, [&](const Vec3& v) { met.push_back(v.x); });
  EXPECT_THAT(met, ElementsAre(1, 2, 3, 4, 5, 6, 7));
}

TEST(StateFields, TheFirstThatIsNotFiniteIsNamed) {
  State state;
  resize(state, 3, 2);
  EXPECT_EQ(first_not_finite(state), std::nullopt);
  state.ball_angular_velocity[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(first_not_finite(state), "ball 1");
  state.velocity[1].z = std::numeric_limits<double>::infinity();
  EXPECT_EQ(first_not_finite(state), "particle 1");
  state.position[2].x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(first_not_finite(state), "particle 1");
}

/// Vectors i: (i + 0.1, i + 0.2, i + 0.3) in a form of memory.
template <class T>
struct Form {
  std::vector<T> memory;
  Strided<T> view;
  Form(std::size_t count, std::ptrdiff_t stride, std::ptrdiff_t component)
      : memory(200, T(-1)), view{memory.data() + 2, count, stride, component} {}
  void fill() {
    for (std::size_t i = 0; i < view.count; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        view.at(i, c) = static_cast<T>(static_cast<double>(i) + 0.1 * static_cast<double>(c + 1));
  }
};

template <class From, class To>
void expect_copies() {
  constexpr std::size_t count = 11;
  const std::pair<std::ptrdiff_t, std::ptrdiff_t> forms[] = {{3, 1}, {1, 16}, {8, 1}, {4, 1}, {1, 11}};
  for (const auto& [stride, component] : forms) {
    for (const auto& [to_stride, to_component] : forms) {
      Form<From> from(count, stride, component);
      from.fill();
      Form<To> to(count, to_stride, to_component);
      copy_vectors(Strided<const From>{from.view.data, count, stride, component}, to.view);
      std::size_t written = 0;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(to.view.at(i, c), static_cast<To>(from.view.at(i, c)));
      for (const To x : to.memory) written += x != To(-1);
      EXPECT_EQ(written, 3 * count) << "numbers between the vectors stay as they were";
    }
  }
}

TEST(StateView, CopiesBetweenAllForms) {
  expect_copies<float, float>();
  expect_copies<double, double>();
  expect_copies<float, double>();
  expect_copies<double, float>();
}

TEST(StateView, NumbersTooLargeForAFloatBecomeInfinite) {
  const std::vector<Vec3> from = {{1e39, -1e300, 1e-60}};
  float to[3];
  copy_vectors(vectors_of(from), Strided<float>{to, 1});
  EXPECT_EQ(to[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(to[1], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(to[2], 0.0f);
}

TEST(StateView, NothingIsCopiedFromOrToNone) {
  float to[3] = {1, 2, 3};
  copy_vectors(std::monostate(), Strided<float>{to, 1});
  EXPECT_THAT(to, ElementsAre(1, 2, 3));
  const std::vector<Vec3> from(4);
  copy_vectors(vectors_of(from), std::monostate());
}

TEST(StateView, OfAStateIsTheState) {
  State state = test::random_bits_state(5, Precision::double_);
  const State before = state;
  State other;
  resize(other, state.position.size(), state.ball_position.size());
  const StateView to = view_of(other);
  const ConstStateView from = view_of(before);
  for (std::size_t n = 0; n < to.size(); ++n) copy_vectors(from[n], to[n]);
  other.step = state.step;
  other.precision = state.precision;
  EXPECT_EQ(other, state);
}

TEST(StateView, SizesAreChecked) {
  ModelSettings settings = test::cube_on_plane(2);
  settings.balls.resize(1);
  const Model model = test::build(settings);
  State state = initial_state(model, Precision::single);
  EXPECT_TRUE(check_sizes(model, view_of(state)).ok());
  EXPECT_TRUE(check_sizes(model, StateView()).ok());
  EXPECT_THAT(check_sizes(model, ConstStateView(), true).error().message(),
              HasSubstr("0 vectors of position, the scene has 8 particles"));
  state.ball_velocity.clear();
  EXPECT_THAT(check_sizes(model, view_of(state)).error().message(),
              HasSubstr("0 vectors of ball_velocity, the scene has 1 balls"));
}

}  // namespace
}  // namespace aspic
