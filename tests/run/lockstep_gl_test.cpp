// Several gpu solvers in one process: each has its own bits, in a context of its own or in one for all,
// whatever is called when and whichever goes first.
#include <EGL/egl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gpu/pixel_ring.h"
#include "render/renderer.h"
#include "run/backends.h"
#include "run/lockstep.h"
#include "run/window_host.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t steps = 40;
constexpr const char* variants[] = {"gpu:lattice", "gpu:gather", "gpu:per-spring", "gpu:fast"};

/// A cube that meets the plane within these steps.
ModelSettings cube(int edge, double height = 2.05) {
  ModelSettings settings = test::cube_on_plane(edge, height);
  settings.simulation.integrator = Integrator::runge_kutta_4;
  return settings;
}

class SeveralGpuSolvers : public aspic::testing::GlTest {
 protected:
  static std::shared_ptr<gl::Context> another_context() {
    return test::value_of(
        gl::Context::create_headless({.debug = true, .device = aspic::testing::test_device()}));
  }
  /// A solver in `context`, or in one of its own if that is null.
  template <class AnyModel>
  static Backend make(const std::string& variant, const AnyModel& model, gl::Context* context) {
    const auto choice = parse_backend(variant);
    EXPECT_TRUE(choice.ok());
    auto own = context || !choice->row->needs_context ? nullptr : another_context();
    SolverHost host;
    host.context = own ? own.get() : context;
    return test::value_of(make_backend(*choice, model, host));
  }
  static std::string hash_of(const Backend& backend) {
    const auto state = backend.solver->state();
    EXPECT_TRUE(state.ok()) << state.error().message();
    return state.ok() ? state_hash_text(*state) : "";
  }
  static std::string hash_after(const Backend& backend, std::uint64_t count) {
    const auto advanced = backend.solver->advance(count);
    EXPECT_TRUE(advanced.ok()) << advanced.error().message();
    return hash_of(backend);
  }
  template <class AnyModel>
  static std::string hash_alone(const std::string& variant, const AnyModel& model, gl::Context* context) {
    return hash_after(make(variant, model, context), steps);
  }
};

TEST_F(SeveralGpuSolvers, EveryPairOfVariantsHasTheBitsOfEach) {
  const Model model = test::build(cube(5));
  const std::string reference = hash_alone("reference", model, nullptr);
  std::map<std::string, std::string> alone;
  for (const char* variant : variants) {
    alone[variant] = hash_alone(variant, model, &context());
    EXPECT_EQ(alone[variant] == reference, variant != std::string("gpu:fast")) << variant;
  }
  for (const bool shared : {true, false}) {
    for (const char* one : variants) {
      for (const char* other : variants) {
        SCOPED_TRACE(std::string(one) + " and " + other + (shared ? " in one context" : " in two"));
        // Both orders are in the loops; in contexts of their own, which take longer to make, a few pairs do.
        if (!shared && one != variants[3] && other != variants[3] && one != variants[1]) continue;
        const Backend first = make(one, model, shared ? &context() : nullptr),
                      second = make(other, model, shared ? &context() : nullptr);
        const auto compared =
            compare_in_lockstep(*first.solver, *second.solver, steps, [](std::uint64_t) { return true; });
        ASSERT_TRUE(compared.ok()) << compared.error().message();
        EXPECT_EQ(compared->hash[0], alone[one]);
        EXPECT_EQ(compared->hash[1], alone[other]);
        EXPECT_EQ(compared->first_difference.has_value(), alone[one] != alone[other]);
      }
    }
  }
}

// Scenes of different sizes and methods, in turns, and either one gone first.
TEST_F(SeveralGpuSolvers, TakeTurnsAndGoInAnyOrder) {
  ModelSettings implicit = cube(4);
  implicit.simulation.integrator = Integrator::implicit_euler;
  implicit.balls.emplace_back();
  implicit.balls[0].position = {0.0, 6.0, 0.0};
  const Model models[] = {test::build(cube(5)), test::build(implicit)};
  const std::string expected[] = {hash_alone("reference", models[0], nullptr),
                                  hash_alone("reference", models[1], nullptr)};
  for (const std::size_t goes_first : {0u, 1u}) {
    Backend backends[] = {make("gpu", models[0], nullptr), make("gpu", models[1], nullptr)};
    for (std::uint64_t n = 0; n < steps; n += 10)
      for (Backend& backend : backends) ASSERT_TRUE(backend.solver->advance(10).ok());
    EXPECT_EQ(hash_of(backends[0]), expected[0]);
    EXPECT_EQ(hash_of(backends[1]), expected[1]);
    // The one that stays was not the last to be used.
    Backend& stays = backends[1 - goes_first];
    backends[goes_first] = Backend();
    ASSERT_TRUE(stays.solver->load(initial_state(stays.solver->model(), Precision::single)).ok());
    EXPECT_EQ(hash_after(stays, steps), expected[1 - goes_first]);
  }
}

TEST_F(SeveralGpuSolvers, ABackendIsAssignedOverALiveOne) {
  const Model model = test::build(cube(4));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend backend = make("gpu", model, nullptr);
  gpu_of(backend)->set_profiling(true);
  ASSERT_TRUE(backend.solver->advance(5).ok());
  backend = make("gpu:gather", model, nullptr);
  EXPECT_EQ(hash_after(backend, steps), expected);
  backend = make("reference", model, nullptr);
  EXPECT_EQ(hash_after(backend, steps), expected);
  EXPECT_EQ(context_of(backend), nullptr);
}

// Of a backend the solver alone is left.
TEST_F(SeveralGpuSolvers, ASolverHoldsItsModelAndItsContext) {
  const std::string expected = hash_alone("reference", test::build(cube(4)), nullptr);
  for (const char* variant : {"gpu", "cpu", "reference"}) {
    SCOPED_TRACE(variant);
    std::unique_ptr<Solver> solver;
    std::weak_ptr<const Model> model;
    std::weak_ptr<gl::Context> own;
    {
      const SharedModel held = shared(test::build(cube(4)));
      Backend backend = make(variant, held, nullptr);
      model = held;
      if (gl::Context* const context = context_of(backend)) own = context->weak_from_this();
      EXPECT_EQ(&backend.solver->model(), held.get()) << "it was copied";
      solver = std::move(backend.solver);
    }
    EXPECT_EQ(own.expired(), !find_backend(variant)->needs_context);
    ASSERT_TRUE(solver->advance(steps).ok());
    EXPECT_EQ(state_hash_text(*solver->state()), expected);
    solver.reset();
    EXPECT_TRUE(model.expired());
    EXPECT_TRUE(own.expired());
  }
}

TEST_F(SeveralGpuSolvers, BackendsAreSwappedAndMoved) {
  const SharedModel model = shared(test::build(cube(4)));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend first = make("gpu", model, nullptr), second = make("gpu:gather", model, nullptr);
  ASSERT_TRUE(first.solver->advance(steps / 2).ok());
  std::swap(first, second);
  EXPECT_EQ(first.variant(), "gpu:gather");
  Backend third = std::move(second);
  second = std::move(first);
  EXPECT_EQ(hash_after(third, steps / 2), expected);
  third = Backend();
  EXPECT_EQ(hash_after(second, steps), expected);
}

// What was current stays so: programs with contexts of their own need not know of ours.
TEST_F(SeveralGpuSolvers, LeaveTheThreadsContextAsItWas) {
  const Model model = test::build(cube(3));
  Backend backend = make("gpu", model, nullptr);
  ASSERT_TRUE(context().make_current().ok());
  const EGLContext before = eglGetCurrentContext();
  ASSERT_TRUE(backend.solver->advance(3).ok());
  EXPECT_EQ(eglGetCurrentContext(), before);
  (void)hash_of(backend);
  gpu_of(backend)->set_profiling(true);
  (void)gpu_of(backend)->pass_times();
  EXPECT_EQ(eglGetCurrentContext(), before);
  backend = Backend();
  EXPECT_EQ(eglGetCurrentContext(), before);
}

TEST_F(SeveralGpuSolvers, ACallFromAnotherThreadIsRefusedAndSaysSo) {
  const Model model = test::build(cube(3));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend backend = make("gpu", model, nullptr);
  ASSERT_TRUE(context_of(backend)->make_current().ok());
  std::vector<std::string> answers;
  std::thread([&] {
    const auto note = [&](const auto& result) {
      answers.push_back(result.ok() ? "done" : result.error().message());
    };
    note(backend.solver->advance(1));
    note(backend.solver->state());
    note(backend.solver->load(initial_state(model, Precision::single)));
    note(backend.solver->set_inputs({{Pull{0, {}, 1.0, 0.0}}}));
    note(make_backend({find_backend("gpu")}, model, {context_of(backend), nullptr, {}}));
  }).join();
  EXPECT_THAT(answers, ::testing::Each(HasSubstr("is in use on another thread")));
  EXPECT_EQ(hash_after(backend, steps), expected);  // and nothing has happened to it
}

// The objects go when the thread that has the context calls next; none of its own is touched.
TEST_F(SeveralGpuSolvers, ASolverMayGoOnAnotherThread) {
  const Model model = test::build(cube(3));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend stays = make("gpu", model, &context()), goes = make("gpu", model, &context());
  ASSERT_TRUE(goes.solver->advance(2).ok());
  const std::uint64_t held = context().bytes_held();
  std::thread([&] { goes = Backend(); }).join();
  EXPECT_EQ(context().bytes_held(), held);
  EXPECT_EQ(hash_after(stays, steps), expected);
  EXPECT_LT(context().bytes_held(), held);
}

TEST_F(SeveralGpuSolvers, ABackendMayGoOnAnotherThreadWithItsContext) {
  const SharedModel model = shared(test::build(cube(3)));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend backend = make("gpu", model, nullptr);
  ASSERT_TRUE(context_of(backend)->make_current().ok());
  ASSERT_TRUE(backend.solver->advance(2).ok());
  std::thread([&] { backend = Backend(); }).join();
  backend = make("gpu", model, nullptr);
  EXPECT_EQ(hash_after(backend, steps), expected);
}

// A context that is current on no thread goes to the one that calls, and one whose thread has ended is free.
TEST_F(SeveralGpuSolvers, ASolverMadeOnAThreadThatEndedIsUsedOnAnother) {
  const SharedModel model = shared(test::build(cube(3)));
  const std::string expected = hash_alone("reference", model, nullptr);
  Backend backend;
  std::thread([&] { backend = make("gpu", model, nullptr); }).join();
  EXPECT_EQ(hash_after(backend, steps), expected);
}

/// A renderer with the read-back of its images, in a context.
struct Painter {
  Painter(gl::Context& context, const Model& model) {
    renderer = test::value_of(Renderer::create(context));
    EXPECT_TRUE(renderer->set_model(model).ok());
    ring.emplace(test::value_of(gl::PixelRing::create(context, 64, 48)));
  }
  std::vector<std::byte> image(const State& state) {
    const auto there = renderer->upload(state);
    EXPECT_TRUE(there.ok());
    const Status drawn = renderer->draw(64, 48, *there, {});
    EXPECT_TRUE(drawn.ok()) << (drawn.ok() ? "" : drawn.error().message());
    ring->submit(renderer->image());
    std::vector<std::byte> rgb;
    EXPECT_TRUE(ring->take(rgb).ok());
    return rgb;
  }
  std::unique_ptr<Renderer> renderer;
  std::optional<gl::PixelRing> ring;
};

TEST_F(SeveralGpuSolvers, ImagesInTwoContextsTakeTurnsAndGoInAnyOrder) {
  const Model models[] = {test::build(cube(3)), test::build(cube(4, 3.0))};
  const State states[] = {initial_state(models[0], Precision::single),
                          initial_state(models[1], Precision::single)};
  const std::vector<std::byte> alone[] = {Painter(context(), models[0]).image(states[0]),
                                          Painter(context(), models[1]).image(states[1])};
  EXPECT_NE(alone[0], alone[1]);
  for (const std::size_t goes_first : {0u, 1u}) {
    const std::shared_ptr<gl::Context> contexts[] = {another_context(), another_context()};
    std::optional<Painter> painters[2];
    for (std::size_t i = 0; i < 2; ++i) painters[i].emplace(*contexts[i], models[i]);
    for (int n = 0; n < 2; ++n)
      for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(painters[i]->image(states[i]), alone[i]);
    const std::size_t stays = 1 - goes_first;
    EXPECT_EQ(painters[stays]->image(states[stays]), alone[stays]);
    painters[goes_first].reset();
    EXPECT_EQ(painters[stays]->image(states[stays]), alone[stays]);
  }
}

}  // namespace
}  // namespace aspic
