// A battery that cannot fail proves nothing: each row is shown a solver of a slightly wrong model and has to
// notice.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <memory>
#include <string>

#include "verify/check.h"

namespace aspic::verify {
namespace {

using Fault = std::function<void(Model&)>;

/// The right solver of the wrong model.
class FaultySolver final : public Solver {
 public:
  FaultySolver(const Model& right, const Fault& fault, const Subject& product, Precision precision)
      : right_(right), wrong_(std::make_unique<Model>(right)) {
    fault(*wrong_);
    inner_ = std::move(product.reference(*wrong_, precision)).value();
  }
  std::string_view backend() const override { return inner_->backend(); }
  std::string description() const override { return inner_->description(); }
  Precision precision() const override { return inner_->precision(); }
  const Model& model() const override { return right_; }
  std::uint64_t bytes() const override { return inner_->bytes(); }
  Result<Advance> advance(std::uint64_t steps) override { return inner_->advance(steps); }
  std::optional<SolveStatistics> solve_statistics() override { return inner_->solve_statistics(); }

 private:
  Status take_state(const ConstStateView& view, std::uint64_t step) override {
    return inner_->load(view, step);
  }
  Result<std::uint64_t> give_state(const StateView& view) override { return inner_->read_into(view); }
  Status take_inputs(const Inputs& inputs) override { return inner_->set_inputs(inputs); }
  Status take_constants(SharedModel model, std::uint64_t) override {
    return inner_->set_constants(std::move(model));
  }
  const Model& right_;
  std::unique_ptr<Model> wrong_;
  std::unique_ptr<Solver> inner_;
};

Subject subject_with(const Fault& fault) {
  const Subject right = product(nullptr, "");
  Subject wrong = right;
  wrong.reference = [=](const Model& model, Precision precision) -> Result<std::unique_ptr<Solver>> {
    return std::unique_ptr<Solver>(std::make_unique<FaultySolver>(model, fault, right, precision));
  };
  return wrong;
}

Row row_of(const std::string& name, const Subject& subject) {
  const std::vector<std::string> names = {name};
  const auto checks = select(battery(), names, false);
  EXPECT_TRUE(checks.ok() && checks->size() == 1) << name;
  return evaluate(checks->front(), subject);
}

void use(Model& model, Integrator integrator) {
  model.simulation.integrator = integrator;
}

struct Planted {
  const char* row;
  const char* what;
  Fault fault;
};

class FaultySolvers : public testing::TestWithParam<Planted> {};

TEST_P(FaultySolvers, AreNoticed) {
  const Row right = row_of(GetParam().row, product(nullptr, ""));
  EXPECT_EQ(right.verdict, Verdict::passed) << right.measured;
  const Row wrong = row_of(GetParam().row, subject_with(GetParam().fault));
  EXPECT_EQ(wrong.verdict, Verdict::failed) << GetParam().what << ": " << wrong.measured;
}

INSTANTIATE_TEST_SUITE_P(
    Verify, FaultySolvers,
    testing::Values(
        Planted{"order/midpoint", "explicit Euler instead",
                [](Model& m) { use(m, Integrator::explicit_euler); }},
        Planted{"order/runge-kutta-4", "midpoint instead", [](Model& m) { use(m, Integrator::midpoint); }},
        Planted{"order/explicit-euler", "stiffness off by 1 %",
                [](Model& m) {
                  for (SpringClass& s : m.spring_classes) s.stiffness *= 1.01;
                }},
        Planted{"closed-form/damped/symplectic-euler", "damping off by one part in 10⁸",
                [](Model& m) {
                  for (SpringClass& s : m.spring_classes) s.damping *= 1 + 1e-8;
                }},
        Planted{"closed-form/undamped/implicit-euler", "the one-pass method instead",
                [](Model& m) { use(m, Integrator::implicit_euler_one_pass); }},
        Planted{"stability/real/explicit-euler", "a step 1 % shorter than asked for",
                [](Model& m) { m.simulation.timestep *= 0.99; }},
        Planted{"stability/complex/explicit-euler", "a step 1 % longer than asked for",
                [](Model& m) { m.simulation.timestep *= 1.01; }},
        Planted{"conservation/double/symplectic-euler", "a body force",
                [](Model& m) { m.simulation.gravity.x = 1e-9; }},
        Planted{"conservation/single/symplectic-euler", "explicit Euler instead",
                [](Model& m) { use(m, Integrator::explicit_euler); }},
        Planted{"force/gradient", "one rest length off by 1e-5",
                [](Model& m) { m.spring_classes.back().rest_length *= 1 + 1e-5; }},
        Planted{"force/invariance", "gravity that stays where it was",
                [](Model& m) { m.simulation.gravity.y = -1e-6; }},
        Planted{"contact/bounce", "restitution off by 1e-12",
                [](Model& m) { m.terrain[0].restitution *= 1 + 1e-12; }},
        Planted{"contact/resist", "the Coulomb model on a slope instead",
                [](Model& m) {
                  m.contact.model = ContactModel::coulomb;
                  m.terrain[0].geometry.vectors[1] = {0.6, 0.8, 0.0};
                }},
        Planted{"contact/viscous/midpoint", "friction off by 1e-9",
                [](Model& m) { m.terrain[0].friction *= 1 + 1e-9; }},
        Planted{"contact/stick/explicit-euler", "friction 2 % less",
                [](Model& m) { m.terrain[0].friction *= 0.98; }},
        Planted{"contact/slide/explicit-euler", "friction 0.1 % less",
                [](Model& m) { m.terrain[0].friction *= 0.999; }},
        Planted{"contact/restitution/midpoint", "restitution off by 1e-4",
                [](Model& m) { m.terrain[0].restitution *= 1 - 1e-4; }},
        Planted{"contact/cone/symplectic-euler", "friction off by 1e-4",
                [](Model& m) { m.terrain[0].friction *= 1 - 1e-4; }},
        Planted{"contact/pull", "gravity less than the weak pull",
                [](Model& m) { m.simulation.gravity.y = -9.7; }},
        Planted{"voxels/cantilever", "stiffness 2 % less",
                [](Model& m) {
                  for (SpringClass& s : m.spring_classes) s.stiffness *= 0.98;
                }},
        Planted{"actuation/expansion/all", "an amplitude 1e-6 larger",
                [](Model& m) { m.actuation.actuators[0].amplitude += 1e-6; }},
        Planted{"actuation/bimorph", "an amplitude a twentieth larger",
                [](Model& m) { m.actuation.actuators[0].amplitude *= 1.05; }},
        Planted{"actuation/order/midpoint", "a signal that begins a little late",
                [](Model& m) { m.actuation.actuators[0].start = 1e-5; }},
        Planted{"voxels/bending/3", "stiffness 2 % more",
                [](Model& m) {
                  for (SpringClass& s : m.spring_classes) s.stiffness *= 1.02;
                }},
        Planted{"voxels/mixture", "one kind of spring off by one part in 10⁹",
                [](Model& m) { m.spring_classes.back().stiffness *= 1 + 1e-9; }},
        Planted{"voxels/free-fall/midpoint", "a body force", [](Model& m) { m.simulation.gravity.x = 1e-9; }},
        Planted{"rest/symplectic-euler", "no ground", [](Model& m) { m.terrain.clear(); }},
        Planted{"implicit/dense", "tolerance 1e-4", [](Model& m) { m.simulation.implicit.tolerance = 1e-4; }},
        Planted{"implicit/bounded", "Runge–Kutta instead",
                [](Model& m) { use(m, Integrator::runge_kutta_4); }},
        Planted{"implicit/residual/course/cube-plane", "one iteration at most",
                [](Model& m) { m.simulation.implicit.newton_iterations = 1; }}),
    [](const auto& parameter) {
      std::string name = parameter.param.row;
      for (char& c : name) {
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      }
      return name;
    });

}  // namespace
}  // namespace aspic::verify
